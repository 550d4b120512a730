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

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import SetParametersResult
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


@dataclass(frozen=True)
class Place:
    """A node that another one makes: its namespace, its parameters, and the remappings of the command line."""

    namespace: str
    given: Mapping[str, Any]
    remaps: tuple[str, ...] = ()

    def arguments(self) -> dict[str, Any]:
        """Arguments of rclpy's node that put it there, whatever the process was given."""
        rules = [word for rule in self.remaps for word in ("-r", rule)]
        return {
            "namespace": self.namespace, "use_global_arguments": False,
            "cli_args": ["--ros-args", *rules] if rules else [],
            "parameter_overrides": [Parameter(name, value=value) for name, value in self.given.items()],
        }  # fmt: skip


class AxisNode(Node):
    """Base of the nodes: `parameters`, 1 Hz `/diagnostics` from `health`, `start` and `finish` for subclasses."""

    def __init__(
        self, name: str, settings: Iterable[Setting], simulated_time: bool | None = None, place: Place | None = None
    ) -> None:
        """Declare `settings`; `simulated_time`, unless None, overrides use_sim_time; `place` replaces the command line.

        Raises UsageError for a given value of wrong type or out of range.
        """
        where = place.arguments() if place else {}
        try:
            super().__init__(name, automatically_declare_parameters_from_overrides=True, **where)
        except (InvalidParameterTypeException, InvalidParameterValueException) as error:
            raise UsageError(str(error)) from error
        if simulated_time is not None:
            self._decide_time(simulated_time)
        self.failure: Exception | None = None  # what ended this node; `run` reports it
        self.end: Callable[[], None] = lambda: None  # asks for the end of the process; set by `run`
        self.steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self.parameters = Parameters(self)
        self.parameters.choose(self.chosen)
        self.parameters.declare(settings)
        self.rivals: Rivals | None = None  # of a node whose role only one node in a namespace can have
        self.diagnostics = Diagnostics(self, self._whole_health)

    def _decide_time(self, simulated: bool) -> None:
        """Say so, and refuse it, where use_sim_time is given otherwise than this node needs it."""
        why = f"use_sim_time stays {str(simulated).lower()} here: this node is the source of the simulated time"
        if self.get_parameter("use_sim_time").value is not simulated:
            self.get_logger().warning(why)
            self.set_parameters([Parameter("use_sim_time", value=simulated)])

        def check(parameters: list[Parameter]) -> SetParametersResult:
            wrong = any(one.name == "use_sim_time" and one.value is not simulated for one in parameters)
            return SetParametersResult(successful=not wrong, reason=why if wrong else "")

        self.add_on_set_parameters_callback(check)

    def chosen(self, given: Mapping[str, Any]) -> Mapping[str, Any]:
        """The parameters that this node takes of those that were `given`."""
        return given

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

    def ready(self) -> str:
        """What the log says once the node runs."""
        return "ready"

    def fail(self, failure: Exception) -> None:
        """End the process because of `failure`; from any thread."""
        self.failure = failure
        self.end()

    def finish(self) -> None:
        """Called once before the end, while callbacks are still served and topics still work."""
