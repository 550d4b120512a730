"""A pressure regulator for each chamber."""

from pneumo_ros.plant.effect import Effect, Parameter, State
from pneumo_ros.plant.effects.valve.pressure_regulator import regulated


class SecondRegulator(Effect):
    """Chamber b has a regulator of its own, of the same type as that of chamber a, with its own command U_b.

    Needs `pressure_regulator`, listed before it, whose figures it has.
    """

    share_b = Parameter(
        1.0, "1", "share of the opening at port b that is its own", 0.0, 1.0, neutral=0.0, optional=True, chosen=True
    )

    r_b = State("Pa", "gauge pressure that the regulator of chamber b holds")
    r_b_rate = State("Pa/s", "its rate of change")

    source = "as `pressure_regulator`"
    signature = "the recording has a second command, and the pressure of chamber b follows it"
    remedy = "compare both regulators with their data sheet: they are taken to be of one type"
    part = True

    def equations(
        U_b, opening_b, p_b, p_atm, r_b, r_b_rate, share_b, pressure_regulator__pressure_range,
        pressure_regulator__full_signal, pressure_regulator__angular_frequency, pressure_regulator__damping_ratio,
        pressure_regulator__dead_band, pressure_regulator__band,
    ):  # fmt: skip
        omega, reach = pressure_regulator__angular_frequency, pressure_regulator__pressure_range
        wanted = min(max(U_b / pressure_regulator__full_signal, 0.0), 1.0) * reach
        rate_r_b_rate = 2.0 * pressure_regulator__damping_ratio * omega
        der_r_b = r_b_rate
        der_r_b_rate = omega * omega * (wanted - r_b) - rate_r_b_rate * r_b_rate
        error = p_atm + r_b - p_b
        own = pressure_regulator__full_signal * regulated(
            error, pressure_regulator__dead_band * reach, pressure_regulator__band
        )
        opening_b = opening_b + share_b * (own - opening_b)
        return opening_b, der_r_b, der_r_b_rate, rate_r_b_rate
