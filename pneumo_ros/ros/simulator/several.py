"""A machine of several axes: a simulator for each, in a namespace of its name, and a node for what they share.

One kernel moves all of them, so pause, single steps and /clock belong to the machine; reset, health and parameters to
each axis.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import FluidPressure

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.sections import listed_axes, of_the_machine, settings_of
from pneumo_ros.axis.simulator.force_input import pushed
from pneumo_ros.axis.simulator.machine import machine_of_axes
from pneumo_ros.axis.simulator.settings import OF_ALL_AXES, OF_ONE_AXIS
from pneumo_ros.axis.simulator.shared_plant import SharedPlant
from pneumo_ros.axis.simulator.together import Together
from pneumo_ros.errors import UsageError
from pneumo_ros.multiaxis import Machine
from pneumo_ros.multiaxis.machine_file import holds_axes
from pneumo_ros.plant.axes_section import AXES, place_of
from pneumo_ros.records.contract import SUPPLY_PRESSURE
from pneumo_ros.ros import messages
from pneumo_ros.ros.description import Description, describe
from pneumo_ros.ros.node import AxisNode, Place
from pneumo_ros.ros.parameters import Parameters
from pneumo_ros.ros.qos import PUBLISH
from pneumo_ros.ros.simulator.engine import Engine
from pneumo_ros.ros.simulator.node import Member, Simulator
from pneumo_ros.ros.simulator.services import Reset, Services

LINK = "supply"  # the frame of the supply's pressure


def simulators(effects_files: Iterable[str | Path], ros_args: Sequence[str]) -> list[AxisNode]:
    """The nodes of what the parameters describe: one simulator, or those of several axes and what they share.

    Raises UsageError as `Simulator`.
    """
    files = tuple(effects_files)
    if not has_axes():
        return [Simulator(files)]
    shared = SharedSimulator(files)
    return [*shared.axes(remaps(ros_args)), shared]


def has_axes() -> bool:
    """Whether the process was given a machine of several axes; a node that says nothing reads its parameters."""
    node = Node(
        "simulator", automatically_declare_parameters_from_overrides=True, start_parameter_services=False,
        enable_rosout=False,
    )  # fmt: skip
    given = Parameters(node).given
    node.destroy_node()
    named = str(given.get("model", ""))
    return AXES in given or (bool(named) and place_of(named)[1] is None and holds_axes(named))


def remaps(ros_args: Sequence[str]) -> tuple[str, ...]:
    """The rules of a command line for topics and services: without those for a node's namespace and name."""
    rules = [word for flag, word in pairwise(ros_args) if flag in ("-r", "--remap")]
    return tuple(rule for rule in rules if rule.partition(":=")[0] not in ("__ns", "__node", "__name"))


class SharedSimulator(AxisNode):
    """What the axes share: the engine, the line and its pressure, /clock, and the description of the whole machine."""

    def __init__(self, effects_files: tuple[str | Path, ...]) -> None:
        """Raises UsageError for an unknown axis, effect or parameter, and for a bad value."""
        super().__init__("simulator", OF_ALL_AXES, simulated_time=False)
        values, self._files = self.parameters, effects_files
        self._given: dict[str, Any] = dict(values.given)
        self._described: Description | None = None
        machine = self._machine()
        if values["coupled"]:
            example = f"-p model:=two.yaml:{next(iter(machine.axes))}"
            raise UsageError(f"coupled takes one axis; start a simulator for each, with {example} and a namespace")
        whole = machine.with_axes({axis: pushed(one) for axis, one in machine.axes.items()})
        rate, step = values["publish_rate"], values["step"]
        self._plant, self._models = SharedPlant(whole, sample_time=1.0 / rate, step=step), machine.axes
        self.engine = Engine(self, Together(self._plant))
        self._clock_topic = self.create_publisher(Clock, "/clock", PUBLISH) if self.engine.simulated_time else None
        self._pressure_topic = (
            self.create_publisher(FluidPressure, SUPPLY_PRESSURE, PUBLISH) if machine.supply else None
        )
        self._messages = messages.clock(), messages.pressure(LINK)
        self.engine.serve(self._send)  # before the axes: who has a joint state has the whole sample

    def _machine(self) -> Machine:
        axes = listed_axes(self._given)
        return machine_of_axes(self.parameters["model"], of_the_machine(self._given, axes, OF_ONE_AXIS), self._files)

    def axes(self, rules: tuple[str, ...]) -> list[Simulator]:
        """The simulators of the axes, in their order; `rules` of remapping hold for each."""
        below = self.get_namespace().rstrip("/")
        nodes = []
        for k, (axis, model) in enumerate(self._models.items()):
            own = {setting.name: self.parameters[setting.name] for setting in OF_ALL_AXES}
            own |= {"joint_name": axis, "seed": own["seed"] + k, "model": f"{own['model']}:{axis}"}
            place = Place(f"{below}/{axis}", own | settings_of(self._given, axis, OF_ONE_AXIS), rules)
            nodes.append(Simulator(self._files, member=Member(axis, place, model, self.engine, self._adopted)))
        self._service_calls = Reset(self, self.engine, self.engine.plant), Services(self, self.engine)
        self._described = Description(self, self._describe)
        return nodes

    def _adopted(self) -> None:
        if self._described:
            self._described.publish()

    def _describe(self) -> dict[str, object]:
        axes = {axis: one.described for axis, one in self._together.simulations.items()}
        return describe(self._plant.machine.with_axes(axes).as_dict(), self.parameters["seed"])

    @property
    def _together(self) -> Together:
        assert isinstance(self.engine.plant, Together)
        return self.engine.plant

    def _send(self, stamp: int) -> None:
        clock, pressure = self._messages
        if self._clock_topic:
            self._clock_topic.publish(clock.fill(stamp))
        if self._pressure_topic:
            self._pressure_topic.publish(pressure.fill(stamp, self._plant.supply_pressure, 0.0))

    # --- life -------------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin at the initial states; the axes' nodes have been started before."""
        self.engine.start()

    def ready(self) -> str:
        """The axes."""
        return f"ready: the axes {', '.join(self._models)} on one supply"

    def finish(self) -> None:
        """Stop the plant."""
        self.engine.stop()

    def health(self) -> Health:
        """Time and supply of the machine; the axes report the rest."""
        values = {"axes": ", ".join(self._models), "simulated_time_s": self.engine.plant.time}
        values |= {"supply_pressure_Pa": self._plant.supply_pressure}
        fault = self.engine.fault
        return Health(values, ["paused"] * (self.engine.paused and not fault), [fault] if fault else [])
