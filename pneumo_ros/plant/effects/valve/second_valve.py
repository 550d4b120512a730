"""A valve for each chamber."""

from pneumo_ros.plant.effect import Effect, Parameter, State

FASTEST = 1000.0  # rad/s, at which a recording shows only a delay: above half of it the lag fades out


class SecondValve(Effect):
    """Chamber b has a valve of its own, with its own command U_b: two 3/3 valves in place of one 5/3 valve.

    U_b above its closed signal fills chamber b, below it empties it. The valve has its own null offset, overlap and
    spool, x'' = omega^2 (U_b + U_0 - x) - 2 zeta omega x'; its flow follows the same law as that of chamber a.
    """

    share = Parameter(
        1.0,
        "1",
        "share of the opening at port b that is its own",
        0.0,
        1.0,
        neutral=0.0,
        optional=True,
        chosen=True,
    )
    offset = Parameter(0.0, "V", "voltage U_0 added to its command", low=-10.0, high=10.0, neutral=0.0)
    fill_limit = Parameter(0.0, "V", "voltage at which port b begins to fill", low=0.0, high=10.0, neutral=0.0)
    empty_limit = Parameter(
        0.0, "V", "magnitude of the voltage at which port b begins to empty", low=0.0, high=10.0, neutral=0.0
    )
    angular_frequency = Parameter(
        FASTEST, "rad/s", "natural angular frequency omega of its spool", low=5.0, high=FASTEST, neutral=FASTEST
    )
    damping_ratio = Parameter(0.7, "1", "damping ratio zeta of its spool", low=0.2, high=5.0, role="damping")

    x_b = State("V", "spool position of the valve of chamber b")
    w_b = State("V/s", "spool velocity of the valve of chamber b")

    source = "Beater 2007, Pneumatic Drives (two 3/3 valves); spool as in `valve_spool_dynamics`"
    signature = "the recording has a second command, and chamber b follows it"
    remedy = "compare its zero, overlap and speed with the data sheet, and with those of the valve of chamber a"
    part = True

    def equations(
        U_b, asked_b, x_b, w_b, share, offset, fill_limit, empty_limit, angular_frequency, damping_ratio
    ):  # fmt: skip
        omega, volts = angular_frequency, U_b + offset
        rate_w_b = 2.0 * damping_ratio * omega
        der_x_b = w_b
        der_w_b = omega * omega * (volts - x_b) - rate_w_b * w_b
        spool = volts + min(2.0 * (FASTEST - omega) / FASTEST, 1.0) * (x_b - volts)
        own = max(spool - fill_limit, 0.0) + min(spool + empty_limit, 0.0)
        asked_b = asked_b + share * (own - asked_b)
        return asked_b, der_x_b, der_w_b, rate_w_b
