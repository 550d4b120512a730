"""A proportional pressure regulator in place of a flow valve."""

from pneumo_ros.plant.effect import Effect, Parameter, State


def regulated(error: float, dead: float, band: float) -> float:
    """Share of full opening, -1 to 1, at a pressure error: none inside the dead band, full `band` beyond it."""
    beyond = error - min(max(error, -dead), dead)
    return min(max(beyond / band, -1.0), 1.0)


class PressureRegulator(Effect):
    """A regulator holds the pressure of chamber a that the command asks for; chamber b is open to the atmosphere.

    The wanted pressure r follows U / U_full of the range with a lag of second order, r'' = omega^2 (p_wanted - r) -
    2 zeta omega r'. The regulator opens in proportion to the error p_atm + r - p_a beyond its dead band, fully at
    `band`, and passes what its supply and its exhaust edge pass.
    """

    share = Parameter(
        1.0, "1", "share of the opening that is the regulator's", 0.0, 1.0, neutral=0.0, optional=True, chosen=True
    )
    pressure_range = Parameter(6e5, "Pa", "gauge pressure at full signal", low=1e4, high=2e6, chosen=True)
    full_signal = Parameter(10.0, "V", "command U_full of the whole range", low=0.1, high=20.0, chosen=True)
    angular_frequency = Parameter(40.0, "rad/s", "natural angular frequency omega of its loop", low=2.0, high=1e3)
    damping_ratio = Parameter(0.9, "1", "damping ratio zeta of its loop", low=0.2, high=5.0, role="damping")
    dead_band = Parameter(1e-3, "1", "half width of the dead band, share of the range", low=0.0, high=0.2)
    band = Parameter(2e4, "Pa", "pressure error beyond it at which it opens fully", low=5e3, high=1e6)

    r_a = State("Pa", "gauge pressure that the regulator of chamber a holds")
    r_a_rate = State("Pa/s", "its rate of change")

    source = (
        "Sorli, Figliolini and Pastorelli 2004, Dynamic model and experimental investigation of a pneumatic "
        "proportional pressure valve"
    )
    signature = "the pressure of chamber a rests at a value that the command sets, whatever the piston does"
    remedy = "compare response and dead band with the data sheet; a slower one lacks supply flow or has dirt"
    part = True

    def equations(
        voltage, opening_a, opening_b, p_a, p_atm, r_a, r_a_rate, share, pressure_range, full_signal,
        angular_frequency, damping_ratio, dead_band, band,
    ):  # fmt: skip
        omega, wanted = angular_frequency, min(max(voltage / full_signal, 0.0), 1.0) * pressure_range
        rate_r_a_rate = 2.0 * damping_ratio * omega
        der_r_a = r_a_rate
        der_r_a_rate = omega * omega * (wanted - r_a) - rate_r_a_rate * r_a_rate
        own = full_signal * regulated(p_atm + r_a - p_a, dead_band * pressure_range, band)
        opening_a = opening_a + share * (own - opening_a)
        opening_b = opening_b - share * (full_signal + opening_b)
        return opening_a, opening_b, der_r_a, der_r_a_rate, rate_r_a_rate
