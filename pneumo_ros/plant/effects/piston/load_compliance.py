"""A load that swings on the rod."""

from pneumo_ros.plant.effect import Effect, Parameter, State, pi


class LoadCompliance(Effect):
    """Part of the mass hangs on a spring and damper: stretch d = y_l - y, v_l' = -omega^2 d - 2 zeta omega (v_l - v).

    That part is taken out of the rigid mass, so that slow motion is unchanged.
    """

    load_mass = Parameter(
        2.0, "kg", "mass M_l behind the spring, part of the moving mass", low=0.0, high=1e4, neutral=0.0
    )
    frequency = Parameter(20.0, "Hz", "natural frequency of the load on its spring, rod held", low=0.5, high=200.0)
    damping_ratio = Parameter(0.05, "1", "damping ratio zeta of the same", low=0.0, high=2.0)

    stretch = State("m", "deflection of the spring")
    v_l = State("m/s", "velocity of the load")

    source = "two-mass system, e.g. Isermann 2005, Mechatronic Systems, Sec. 4.4"
    signature = "ringing above the frequency of the air spring"

    def equations(v, stretch, v_l, mass, load_mass, frequency, damping_ratio):
        omega = 2.0 * pi * frequency
        share = min(load_mass, 0.9 * mass)
        rate_v_l = 2.0 * damping_ratio * omega
        der_stretch = v_l - v
        der_v_l = -omega * omega * stretch - rate_v_l * (v_l - v)
        added_mass = -share
        force = -share * (omega * omega * stretch + rate_v_l * (v_l - v))
        resistance = share * rate_v_l
        return added_mass, force, resistance, der_stretch, der_v_l, rate_v_l
