"""Friction of a transmission that the load presses together."""

from pneumo_ros.plant.effect import Effect, Parameter


class LoadDependentFriction(Effect):
    """Coulomb and static friction rise with the force that passes a gear or screw: F_c, F_s += k |drive + load| / 2.

    The drive pushes one side of the teeth and the load the other; at rest and in steady motion both are nearly equal.
    For machines that a measured force drives: the seals of a cylinder are pressed by its pressures.
    """

    coefficient = Parameter(0.1, "1", "rise k of friction over the force that is passed on", 0.0, 1.0, neutral=0.0)

    transmission = True
    source = "Duclusaud et al. 2025, Extended friction models for the physics simulation of servo actuators"
    signature = "friction follows the magnitude of the drive force"
    remedy = "lubricate gear or screw; look at their preload"

    def equations(drive, force, coefficient):
        friction_rise = 0.5 * coefficient * abs(drive + force)
        return friction_rise
