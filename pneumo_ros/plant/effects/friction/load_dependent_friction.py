"""Friction of a transmission that the load presses together."""

from pneumo_ros.plant.effect import Effect, Parameter


class LoadDependentFriction(Effect):
    """Coulomb and static friction rise with the force L = |drive + load| / 2 that passes a gear or screw.

    F_c, F_s += k L + q L^2, and F_s += s L besides. The drive pushes one side of the teeth and the load the other; at
    rest and in steady motion both are nearly equal. For machines without chambers: the seals of a cylinder are pressed
    by its pressures. The usual q is k / F_s of the default machine, 0.1 over 100 N: friction that rises with the square
    of the load then does as much at the usual force of a machine as friction that rises with the load.
    """

    coefficient = Parameter(0.1, "1", "rise k of friction over the force that is passed on", 0.0, 1.0, neutral=0.0)
    growth = Parameter(0.0, "1/N", "its increase q with that force", low=0.0, high=20.0, neutral=0.0, usual=1e-3)
    static = Parameter(0.0, "1", "further rise s of static friction alone", low=0.0, high=1.0, neutral=0.0)

    transmission = True
    source = "Duclusaud et al. 2025, Extended friction models for the physics simulation of servo actuators"
    signature = "friction follows the magnitude of the drive force"
    remedy = "lubricate gear or screw; look at their preload"

    def equations(drive, force, coefficient, growth, static):
        passed = 0.5 * abs(drive + force)
        friction_rise = (coefficient + growth * passed) * passed
        static_rise = static * passed
        return friction_rise, static_rise
