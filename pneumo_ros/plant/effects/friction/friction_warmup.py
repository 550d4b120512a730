"""Friction that falls as the machine warms up."""

from pneumo_ros.plant.effect import Effect, Parameter, exp


class FrictionWarmup(Effect):
    """All dry friction times 1 - a (1 - exp(-t / tau)): grease and seals soften with running time."""

    share = Parameter(0.2, "1", "share a of the friction that is lost when warm", low=-1.0, high=0.9, neutral=0.0)
    time_constant = Parameter(60.0, "s", "time constant tau", low=0.1, high=1e5)

    source = "Armstrong-Helouvry 1991, Control of Machines with Friction (friction falls as a machine warms up)"
    signature = "the magnitude of friction decays with running time"
    remedy = "move the machine some minutes before exact work; look at the grease if it takes long"

    def equations(t, share, time_constant):
        friction_scale = 1.0 - share * (1.0 - exp(-max(t, 0.0) / time_constant))
        return friction_scale
