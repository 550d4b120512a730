"""Friction that lags the velocity."""

from pneumo_ros.plant.effect import Effect, Parameter, State

RESOLVED = 2e-4  # s: shorter lags use a share of this one, which has the same delay without shorter steps


class FrictionLag(Effect):
    """The lubricant film lags velocity: the Stribeck curve depends on v_f, v_f' = (v - v_f) / tau."""

    time_constant = Parameter(5e-3, "s", "time constant tau of the film", low=0.0, high=1.0, neutral=0.0)

    v_f = State("m/s", "lagged velocity of the film", initial="v")

    source = (
        "Hess and Soom 1990, Friction at a lubricated line contact operating at oscillating sliding velocities; "
        "Tran and Yanada 2013, Dynamic friction behaviors of pneumatic cylinders"
    )
    signature = "the loop of friction over velocity widens with frequency"
    remedy = "nothing to repair: a lubricant film has it; keep it in the model"

    def equations(v, v_f, time_constant):
        rate_v_f = 1.0 / max(time_constant, RESOLVED)
        der_v_f = rate_v_f * (v - v_f)
        slip = v + min(time_constant / RESOLVED, 1.0) * (v_f - v)
        return slip, der_v_f, rate_v_f
