"""A position that arrives late."""

from pneumo_ros.plant.effect import Effect, Parameter, State

# Pade approximant (4, 4) of exp(-s): the product of two all-passes (s^2 - B s + C) / (s^2 + B s + C)
B_1, C_1 = 8.4151575887, 45.9512019075
B_2, C_2 = 11.5848424113, 36.5605235611
RESOLVED = 2e-3  # s: shorter delays use a share of this one, which is nearly equal without shorter steps
SHORTEST = 1e-5  # s, of a low-pass: its lag is of first order, which needs no shorter steps


class PositionSensorDelay(Effect):
    """The measured position is late and smoothed: y_m = y - e_1 - e_2 - f.

    The delay is its (4, 4) Pade approximation, as two all-passes in turn, each written for its lag, which is 0 at rest
    at any position: e'' = (2 B v - C e / tau) / tau - B e' / tau, where the second one delays y - e_1. At 50 Hz a delay
    of 15 ms is then met within 0.03 rad; its (2, 2) approximation would be off by 0.9 rad. The low-pass of first order,
    T y_m' + y_m = y - e_1 - e_2, is written for its lag f in the same way: f' = v - e_1' - e_2' - f / T.
    """

    delay = Parameter(5e-3, "s", "delay tau of the position signal", low=0.0, high=0.2, neutral=0.0, role="delay")
    low_pass = Parameter(0.0, "s", "time constant T of its low-pass", low=0.0, high=0.1, neutral=0.0, role="low-pass")

    behind = State("m", "lag e_1 of the signal by the first all-pass")
    v_behind = State("m/s", "rate of change of e_1")
    further = State("m", "lag e_2 by the second all-pass")
    v_further = State("m/s", "rate of change of e_2")
    smoothed = State("m", "lag f of the low-pass")

    source = "Golub and Van Loan, Matrix Computations (Pade approximants of the exponential)"
    signature = "position lags the pressures; the residual follows jerk"
    remedy = "look at filter and bus settings of the position sensor, and at what stamps its messages"

    def equations(v, y_measured, behind, v_behind, further, v_further, smoothed, delay, low_pass):
        tau, share = max(delay, RESOLVED), min(delay / RESOLVED, 1.0)
        rate_v_behind, rate_v_further, rate_smoothed = B_1 / tau, B_2 / tau, 1.0 / max(low_pass, SHORTEST)
        der_behind = v_behind
        der_v_behind = (2.0 * B_1 * v - C_1 * behind / tau) / tau - rate_v_behind * v_behind
        der_further = v_further
        der_v_further = (2.0 * B_2 * (v - v_behind) - C_2 * further / tau) / tau - rate_v_further * v_further
        der_smoothed = v - share * (v_behind + v_further) - rate_smoothed * smoothed
        late = share * (behind + further)
        y_measured = y_measured - late - min(low_pass / SHORTEST, 1.0) * smoothed
        return (
            y_measured, der_behind, der_v_behind, der_further, der_v_further, der_smoothed,
            rate_v_behind, rate_v_further, rate_smoothed,
        )  # fmt: skip
