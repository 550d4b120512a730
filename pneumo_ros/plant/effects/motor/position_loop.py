"""The position loop of a servo."""

from pneumo_ros.plant.effect import Effect, Parameter


class PositionLoop(Effect):
    """Proportional position loop of a servo, duty = k (y_goal - y_measured), limited to -1 to 1.

    The goal is the recorded one. A recorded gain takes the place of k: servos give it in units of their own, which the
    map of a table turns into a share of the full voltage over metres or radians.
    """

    proportional_gain = Parameter(
        1.0, "1/m", "gain k: share of full voltage over position error", low=0.0, high=1e5, chosen=True
    )

    source = "Duclusaud et al. 2025, Extended friction models for the physics simulation of servo actuators"
    signature = "the drive follows the distance from the goal"
    remedy = "nothing to repair: the loop is the machine's own"
    part = True

    def equations(reference, y_measured, position_gain):
        duty = min(max(position_gain * (reference - y_measured), -1.0), 1.0)
        return duty
