"""A position that arrives late."""

from pneumo_ros.plant.effect import Effect, Parameter, State

RESOLVED = 2e-3  # s: shorter delays use a share of this one, which is nearly equal without shorter steps


class PositionSensorDelay(Effect):
    """The measured position is tau old: y_m = y - e, e'' = 12 (v - e / tau) / tau - 6 e' / tau.

    This is the (2, 2) Pade approximation of the delay, written for the lag e, which is 0 at rest at any position.
    """

    delay = Parameter(5e-3, "s", "delay tau of the position signal", low=0.0, high=0.2, neutral=0.0, role="delay")

    behind = State("m", "lag e of the signal")
    v_behind = State("m/s", "rate of change of e")

    source = "Golub and Van Loan, Matrix Computations (Pade approximants of the exponential)"
    signature = "position lags the pressures; the residual follows jerk"

    def equations(v, y_measured, behind, v_behind, delay):
        tau = max(delay, RESOLVED)
        rate_v_behind = 6.0 / tau
        der_behind = v_behind
        der_v_behind = 12.0 * (v - behind / tau) / tau - rate_v_behind * v_behind
        y_measured = y_measured - min(delay / RESOLVED, 1.0) * behind
        return y_measured, der_behind, der_v_behind, rate_v_behind
