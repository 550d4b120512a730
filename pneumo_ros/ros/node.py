"""What all nodes of this package share: parameters from data, diagnostics, and a start and an end of their own.

class Recorder(AxisNode):
    def __init__(self) -> None:
        super().__init__("recorder", SETTINGS)      # declared: self.parameters["name"]
        self.parameters.refuse_unknown()

    def health(self) -> Health: ...                 # /diagnostics, once per second
    def start(self) -> None: ...                    # after the executor runs
    def finish(self) -> None: ...                   # on SIGINT or SIGTERM, while topics still work

def main() -> int:
    return run(lambda: [Recorder()], "recorder")
"""

from collections.abc import Callable, Iterable

from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.setting import Setting
from pneumo_ros.errors import UsageError
from pneumo_ros.ros.diagnostics import Diagnostics
from pneumo_ros.ros.parameters import Parameters
from pneumo_ros.ros.rivals import Rivals


class AxisNode(Node):
    """Base of the nodes: `parameters`, 1 Hz `/diagnostics` from `health`, `start` and `finish` for subclasses."""

    def __init__(self, name: str, settings: Iterable[Setting], simulated_time: bool | None = None) -> None:
        """Declare `settings`; `simulated_time`, unless None, overrides use_sim_time.

        Raises UsageError for a given value of wrong type or out of range.
        """
        decided = [] if simulated_time is None else [Parameter("use_sim_time", value=simulated_time)]
        try:
            super().__init__(name, automatically_declare_parameters_from_overrides=True, parameter_overrides=decided)
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            raise UsageError(str(error)) from error
        self.failure: Exception | None = None  # what ended this node; `run` reports it
        self.end: Callable[[], None] = lambda: None  # asks for the end of the process; set by `run`
        self.steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self.parameters = Parameters(self)
        self.parameters.declare(settings)
        self.rivals: Rivals | None = None  # of a node whose role only one node in a namespace can have
        self.diagnostics = Diagnostics(self, self._whole_health)

    def health(self) -> Health:
        """What /diagnostics says about this node."""
        return Health()

    def _whole_health(self) -> Health:
        health = self.health()
        if self.rivals is not None:
            health.errors += self.rivals.errors
            health.warnings += self.rivals.warnings
        return health

    def start(self) -> None:
        """Called once, when callbacks are being served."""

    def fail(self, failure: Exception) -> None:
        """End the process because of `failure`; from any thread."""
        self.failure = failure
        self.end()

    def finish(self) -> None:
        """Called once before the end, while callbacks are still served and topics still work."""
