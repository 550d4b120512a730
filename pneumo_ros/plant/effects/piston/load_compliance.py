"""A load that swings on the rod."""

from pneumo_ros.plant.effect import Effect, Parameter, State, pi


class LoadCompliance(Effect):
    """A share of the mass hangs on a spring and damper: x' = v_l - v, v_l' = -omega^2 x - 2 zeta omega (v_l - v).

    That share is taken out of the rigid mass, so that slow motion is unchanged.
    """

    load_share = Parameter(0.4, "1", "share of the moving mass behind the spring", low=0.0, high=0.8, neutral=0.0)
    frequency = Parameter(20.0, "Hz", "natural frequency of the load on its spring, rod held", low=0.5, high=100.0)
    damping_ratio = Parameter(0.05, "1", "damping ratio zeta of the same", low=0.0, high=2.0, role="damping")

    stretch = State("m", "deflection x of the spring")
    v_l = State("m/s", "velocity of the load", initial="v")

    source = "two-mass system, e.g. Isermann 2005, Mechatronic Systems"
    signature = "ringing above the frequency of the air spring"
    remedy = "tighten or stiffen the coupling between rod and load"

    def equations(v, stretch, v_l, mass, load_share, frequency, damping_ratio):
        omega, load = 2.0 * pi * frequency, load_share * mass
        rate_v_l = 2.0 * damping_ratio * omega
        der_stretch = v_l - v
        der_v_l = -omega * omega * stretch - rate_v_l * (v_l - v)
        added_mass = -load
        force = load * der_v_l
        resistance = load * rate_v_l
        return added_mass, force, resistance, der_stretch, der_v_l, rate_v_l
