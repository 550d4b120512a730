"""A position that arrives late."""

from pneumo_ros.plant.effect import Effect, Parameter, State

RESOLVED = 2e-3  # s: shorter delays use a share of this one, which is nearly equal without shorter steps
SHORTEST = 1e-5  # s, of a low-pass: its lag is of first order, which needs no shorter steps


class PositionSensorDelay(Effect):
    """The measured position is late and smoothed: y_m = y - e - f with e'' = 12 (v - e / tau) / tau - 6 e' / tau.

    This is the (2, 2) Pade approximation of the delay, written for the lag e, which is 0 at rest at any position. The
    low-pass of first order, T y_m' + y_m = y - e, is written for its lag f in the same way: f' = v - e' - f / T.
    """

    delay = Parameter(5e-3, "s", "delay tau of the position signal", low=0.0, high=0.2, neutral=0.0, role="delay")
    low_pass = Parameter(0.0, "s", "time constant T of its low-pass", low=0.0, high=0.1, neutral=0.0, role="delay")

    behind = State("m", "lag e of the signal")
    v_behind = State("m/s", "rate of change of e")
    smoothed = State("m", "lag f of the low-pass")

    source = "Golub and Van Loan, Matrix Computations (Pade approximants of the exponential)"
    signature = "position lags the pressures; the residual follows jerk"
    remedy = "look at filter and bus settings of the position sensor, and at what stamps its messages"

    def equations(v, y_measured, behind, v_behind, smoothed, delay, low_pass):
        tau, share = max(delay, RESOLVED), min(delay / RESOLVED, 1.0)
        rate_v_behind, rate_smoothed = 6.0 / tau, 1.0 / max(low_pass, SHORTEST)
        der_behind = v_behind
        der_v_behind = 12.0 * (v - behind / tau) / tau - rate_v_behind * v_behind
        der_smoothed = v - share * v_behind - rate_smoothed * smoothed
        y_measured = y_measured - share * behind - min(low_pass / SHORTEST, 1.0) * smoothed
        return y_measured, der_behind, der_v_behind, der_smoothed, rate_v_behind, rate_smoothed
