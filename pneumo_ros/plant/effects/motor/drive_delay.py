"""A loop whose output reaches the motor late."""

from pneumo_ros.plant.effect import Effect, Parameter, State
from pneumo_ros.plant.effects.valve.command_delay import C, D, P

RESOLVED = 2e-3  # s: shorter delays use a share of this one, which is nearly equal without shorter steps


class DriveDelay(Effect):
    """Bus, sampling and computation of a loop let its output act a time tau late: duty(t) = duty_asked(t - tau).

    The delay is its (1, 3) Pade approximation, as in `command_delay`.
    """

    delay = Parameter(5e-3, "s", "delay tau from error to motor", low=0.0, high=0.2, neutral=0.0, role="delay")

    asked_1 = State("1", "duty after the first lag")
    asked_2 = State("1", "duty after the second and third")
    asked_3 = State("1", "its change within the delay")

    source = "Golub and Van Loan, Matrix Computations (Pade approximants of the exponential)"
    signature = "the motion lags the goal by a time that no speed changes, and the loop is damped less"
    remedy = "look at baud rate and return delay of the bus, and at the rate of the loop"

    def equations(duty, asked_1, asked_2, asked_3, delay):
        pace, share = 1.0 / max(delay, RESOLVED), min(delay / RESOLVED, 1.0)
        der_asked_1 = P * pace * (duty - asked_1)
        der_asked_2 = pace * asked_3
        der_asked_3 = pace * (C * (asked_1 - asked_2) - D * asked_3)
        rate_asked_1, rate_asked_3 = P * pace, D * pace
        duty = duty + share * (asked_2 - 0.25 * asked_3 - duty)
        return duty, der_asked_1, der_asked_2, der_asked_3, rate_asked_1, rate_asked_3
