"""A weight that swings."""

from pneumo_ros.plant.effect import Effect, Parameter, sin


class PendulumLoad(Effect):
    """Weight on a lever, F = F_0 sin((y - y_0) / r): the moment m g l about the axis, over the radius r.

    For a rotary machine, in N m and rad, r is 1.
    """

    amplitude = Parameter(
        10.0, "N", "load F_0 where the lever is horizontal", low=-1e5, high=1e5, neutral=0.0, chosen=True
    )
    hanging = Parameter(0.0, "m", "position y_0 at which it hangs", low=-10.0, high=10.0)
    radius = Parameter(1.0, "m", "motion r per radian of the lever", low=1e-3, high=100.0, chosen=True)

    source = "Newton's second law; Duclusaud et al. 2025, whose servos swing a pendulum"
    signature = "a force that follows the sine of the position, whatever the velocity"
    remedy = "look at what hangs on the lever; balance it or enter it"
    part = True

    def equations(y, amplitude, hanging, radius):
        force = amplitude * sin((y - hanging) / radius)
        return force
