"""A test machine that moves the piston."""

from pneumo_ros.plant.effect import Effect


class ImposedMotion(Effect):
    """A test machine imposes the motion: the piston has the recorded velocity, whatever forces act on it.

    For gas springs and cylinders on a test machine, whose pressures the motion determines.
    """

    source = "kinematics: y' = v with v given"
    signature = "the motion does not depend on any force"
    remedy = "nothing to repair: a test machine moves the rod"

    def equations(mass):
        added_mass = 1e9 * mass  # no force of a cylinder changes the motion of so many kg within a step
        return added_mass

    def advance(v, imposed_velocity):
        v = imposed_velocity
        return v
