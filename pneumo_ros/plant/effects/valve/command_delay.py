"""Electronics of a valve that pass the command late."""

from pneumo_ros.plant.effect import Effect, Parameter, State

RESOLVED = 2e-3  # s: shorter delays use a share of this one, which is nearly equal without shorter steps
# Pade approximant of exp(-s), numerator 1 - s / 4, denominator (1 + s / P) (1 + (D s + s^2) / C)
P, C, D = 2.6258168189584645, 9.140013052974366, 3.374183181041531


class CommandDelay(Effect):
    """The valve's electronics pass the command a time tau late: u(t) = U(t - tau), before the spool moves.

    The delay is its (1, 3) Pade approximation, as in `line_delay`: it passes no jump and has the exact mean delay.
    """

    delay = Parameter(3e-3, "s", "delay tau of the command", low=0.0, high=0.2, neutral=0.0, role="delay")

    sent_1 = State("V", "command after the first lag")
    sent_2 = State("V", "command after the second and third")
    sent_3 = State("V", "its change within the delay")

    source = "ISO 10770-1, step response of electrically modulated valves (there hydraulic ones): dead time"
    signature = "both flows follow the command late, at any pressure"
    remedy = "compare the delay with the data sheet; a longer one is that of the amplifier, the bus or the driver"
    part = True

    def equations(voltage, sent_1, sent_2, sent_3, delay):
        pace, share = 1.0 / max(delay, RESOLVED), min(delay / RESOLVED, 1.0)
        der_sent_1 = P * pace * (voltage - sent_1)
        der_sent_2 = pace * sent_3
        der_sent_3 = pace * (C * (sent_1 - sent_2) - D * sent_3)
        rate_sent_1, rate_sent_3 = P * pace, D * pace
        voltage = voltage + share * (sent_2 - 0.25 * sent_3 - voltage)
        return voltage, der_sent_1, der_sent_2, der_sent_3, rate_sent_1, rate_sent_3
