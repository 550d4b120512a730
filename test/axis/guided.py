"""A control loop without ROS, with the piston and clock of the test."""

from pneumo_ros.axis.controller.loop import Loop
from pneumo_ros.control import Machine, Pid, ValveInverse

TICK = 1_000_000  # ns


class Run:
    """A loop and its clock; `go` sends measurements of a piston that stands at `position`."""

    def __init__(self) -> None:
        self.loop, self.stamp, self.position = Loop(Pid(valve=ValveInverse(), machine=Machine()), 0.1), 10**18, 0.0
        self.guide = self.loop.guide
        self.guide.motion.following_error = 10.0
        self.go()

    def go(self, ticks: int = 1, follow: bool = False) -> float | None:
        """The last voltage; on request the piston follows its setpoint exactly."""
        voltage = None
        for _ in range(ticks):
            self.stamp += TICK
            voltage = self.loop.measure(self.stamp, self.position, None)
            if follow and self.loop.wanted is not None:
                self.position = self.loop.wanted.position
        return voltage
