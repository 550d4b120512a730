"""A position that arrives late."""

from pneumo_ros.plant.effect import Effect, Parameter, State

SHORTEST = 1e-6  # s: what is shorter, no step can tell from none


class PositionSensorDelay(Effect):
    """The measured position lags by tau: y_m = y - e, e' = v - e / tau, a delay's first-order stand-in."""

    delay = Parameter(5e-3, "s", "delay tau of the position signal", low=0.0, high=0.2, neutral=0.0)

    e = State("m", "how far the signal is behind")

    source = "first-order (0, 1) Pade approximation of a delay"
    signature = "position lags the pressures; the residual follows jerk"

    def equations(v, y_measured, e, delay):
        rate_e = 1.0 / max(delay, SHORTEST)
        der_e = v - rate_e * e
        y_measured = y_measured - e
        return y_measured, der_e, rate_e
