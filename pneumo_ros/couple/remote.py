"""A cylinder in step with another simulator, of which only the motion of the rod is known: states in, forces out.

`Cylinder.step` needs the mechanism's effective mass m and its acceleration without the cylinder. They are those of the
step before: a = (v1 - v0)/dt - F/m with the force F that was given for that step.
"""

import math

from pneumo_ros.couple.cylinder import Cylinder
from pneumo_ros.errors import UsageError

LONGEST = 0.1  # s between two states; a longer silence is a pause, over which nothing is integrated


class Remote:
    """Answers each state of the rod with the mean force [N] over the step that follows."""

    def __init__(self, cylinder: Cylinder, mass: float, time_step: float) -> None:
        """`mass` [kg] of the mechanism along the rod, until another one is given; `time_step` [s]: the first step."""
        self.cylinder, self.mass = cylinder, mass
        self.first_step = time_step
        self.force = 0.0
        self.restart()

    def restart(self) -> None:
        """The next state begins a new motion: what was before it is forgotten, but for the gas."""
        self._before: tuple[float, float] | None = None  # time [s] and velocity [m/s]
        self._step = self.first_step

    def answer(self, time: float, position: float, velocity: float, voltage: float) -> float:
        """Force [N], above 0 where it extends, for the step after `time` [s], which is taken as long as the last one.

        `position` [m], 0 at mid stroke, and `velocity` [m/s] of the rod at that time; `voltage` [V] at the valve, held.
        Time that goes back, or jumps by more than LONGEST, begins a new motion. Raises UsageError for a number that is
        not finite and a position outside the stroke, NumericalError as `Cylinder.step`.
        """
        if not math.isfinite(time + position + velocity):
            raise UsageError(f"the rod is at {position} m with {velocity} m/s at {time} s; finite numbers are needed")
        reach = 0.5 * self.cylinder.model["piston.stroke"]
        if abs(position) > 1.05 * reach:
            raise UsageError(f"the rod is at {position:.4g} m, outside of its stroke of +-{reach:g} m")
        free = 0.0
        if self._before is not None and not 0.0 < time - self._before[0] <= LONGEST:
            self.restart()
        if self._before is not None:
            self._step = time - self._before[0]
            free = (velocity - self._before[1]) / self._step - self.force / self.mass
        self._before = time, velocity
        self.force = self.cylinder.step(position, velocity, self.mass, free, self._step, voltage)
        return self.force
