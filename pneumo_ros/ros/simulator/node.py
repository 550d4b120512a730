"""The simulator: the plant of one axis as a node."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from std_msgs.msg import Float64

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.roles import PLANT
from pneumo_ros.axis.simulator.coupled import Coupled
from pneumo_ros.axis.simulator.health import Monitor
from pneumo_ros.axis.simulator.machine import machine_from_parameters
from pneumo_ros.axis.simulator.sensors import Sensors
from pneumo_ros.axis.simulator.settings import EFFECTS, FIXED, LIVE, effects_setting, machine_settings
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.simulator.together import Together
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.records.contract import COMMAND, COMMAND_B, FORCE
from pneumo_ros.records.corrections import parse_words, wiring
from pneumo_ros.ros import readers
from pneumo_ros.ros.description import Description, describe
from pneumo_ros.ros.node import AxisNode, Place
from pneumo_ros.ros.peers import loop_closed
from pneumo_ros.ros.qos import RELIABLE, SUBSCRIBE
from pneumo_ros.ros.rivals import Rivals
from pneumo_ros.ros.simulator.coupling import Coupling
from pneumo_ros.ros.simulator.engine import Engine
from pneumo_ros.ros.simulator.outlet import Outlet
from pneumo_ros.ros.simulator.services import Reset, Services
from pneumo_ros.ros.simulator.tuning import Tuning, initial_state
from pneumo_ros.units import KEY


@dataclass(frozen=True)
class Member:
    """One of several axes: its name, place and model, the engine of all, and whom to tell of another model."""

    axis: str
    place: Place
    model: Model
    engine: Engine
    adopted: Callable[[], None]

    @property
    def all(self) -> Together:
        """The simulations of all axes."""
        assert isinstance(self.engine.plant, Together)
        return self.engine.plant


class Simulator(AxisNode):
    """The machine of one axis, in real time or in lockstep: takes `valve/command`, sends sensor readings."""

    def __init__(
        self, effects_files: Iterable[str | Path] = (), tolerated: Callable[[str], bool] = lambda name: False,
        member: Member | None = None,
    ) -> None:  # fmt: skip
        """`member`: what it is among several axes; None for a machine of one axis.

        Raises UsageError for an unknown effect or parameter, unless it is `tolerated`, for a bad value, and where
        there is another plant.
        """
        place = member.place if member else None
        super().__init__("simulator", [*FIXED, *LIVE], simulated_time=False, place=place)  # it is the source of time
        self.rivals = Rivals(self, PLANT)
        files, self._member = tuple(effects_files), member
        self.simulation = self._build(files, tolerated)
        self.rivals.settle()
        coupled = isinstance(self.simulation, Coupled)  # the clock is that of the other side
        self.engine = member.engine if member else Engine(self, self.simulation, driven=coupled)
        self._wired = wiring(parse_words(self.parameters["wired_as"]))
        joint, chambers = self.parameters["joint_name"], self.simulation.model.chambers
        clock = self.engine.simulated_time and not coupled and not member
        self.outlet = Outlet(self, joint, clock, self._wired, chambers)
        self.engine.serve(lambda stamp: self.outlet.send(self.simulation, stamp))
        self._description = Description(self, self._describe)
        self._tuning = self._make_tuning(files)
        self._reset = Reset(self, self.engine, self.simulation)
        self._service_calls = None if member else Services(self, self.engine)
        self._listen()
        self.coupling = Coupling(self, self.simulation) if isinstance(self.simulation, Coupled) else None
        self._monitor = Monitor(self.simulation, self.engine.pace)

    # --- construction -----------------------------------------------------------------------------------------------

    def _build(self, files: tuple[str | Path, ...], tolerated: Callable[[str], bool]) -> Simulation:
        values, member = self.parameters, self._member
        values.refuse_unknown(lambda name: not member and (tolerated(name) or "." in name or name in (EFFECTS, KEY)))
        given = {name: value for name, value in values.given.items() if not tolerated(name)}
        model = member.model if member else machine_from_parameters(values["model"], given, files)
        values.declare([effects_setting(model), *machine_settings(model, list(model.parameters))])
        model.state(**initial_state(values.values()))
        for sentence in model.cautions():
            self.get_logger().warning(sentence)
        valve = ValveInput(values["max_voltage"], values["command_timeout"], closed_signal(model))
        sensors, rate, step = Sensors(seed=values["seed"]), values["publish_rate"], values["step"]
        if member:
            own = member.all.plant.axes[member.axis]
            return member.all.add(member.axis, Simulation(model, valve, sensors, rate=rate, step=step, plant=own))
        kind = Coupled if values["coupled"] else Simulation
        return kind(model, valve, sensors, rate=rate, step=step)

    def _make_tuning(self, files: tuple[str | Path, ...]) -> Tuning:
        member, log = self._member, self.get_logger()
        if member is None:
            return Tuning(self.parameters, self.simulation, self.engine.lock, log, self._description.publish, files)
        axis, plant = member.axis, member.all.plant
        return Tuning(
            self.parameters, self.simulation, self.engine.lock, log, self._adopted, files,
            lambda model: plant.machine.with_axes({axis: model}),
        )  # fmt: skip

    def _adopted(self) -> None:
        """The machine is another one: tell it, alone and among the others."""
        self._description.publish()
        if self._member:
            self._member.adopted()

    def _listen(self) -> None:
        # before that of chamber a: of two commands that have both arrived, it is read first
        self.create_subscription(Float64, COMMAND_B, self._command_b, SUBSCRIBE, raw=True)
        commands = self.create_subscription(Float64, COMMAND, self._command, SUBSCRIBE, raw=True)
        self.create_subscription(Float64, FORCE, self._push, RELIABLE, raw=True)
        self._axis = self._member.axis if self._member else ""
        self.engine.loop(self._axis, lambda: loop_closed(self, self.outlet.joint_states, commands))

    # --- life -------------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin at the initial state."""
        if self._member is None:
            self.engine.start()

    def ready(self) -> str:
        """The machine and its rate."""
        model = self.simulation.model
        return f"ready: {model.name} with {len(model.effects)} effects, joint_states at {self.simulation.rate:g} Hz"

    def finish(self) -> None:
        """Stop the plant."""
        self.engine.stop()

    def simulated_clock(self) -> int:
        """Simulated time [ns]."""
        return self.simulation.clock

    # --- commands ---------------------------------------------------------------------------------------------------

    def _command(self, message: bytes) -> None:
        self._take(self.simulation.valve, readers.number(message))
        self.engine.answered(self._axis)

    def _command_b(self, message: bytes) -> None:
        """The command of the valve of chamber b; in lockstep it comes before that of chamber a, which goes on."""
        valve = self.simulation.valve_b
        if valve in self.simulation.valves:
            self._take(valve, readers.number(message))
        else:
            name = self.simulation.model.name
            self.get_logger().warning(f"{COMMAND_B} is not used: {name} has one command", throttle_duration_sec=10.0)

    def _take(self, valve: ValveInput, sent: float) -> None:
        arrival, voltage = time.monotonic_ns() if self.engine.ticker else 0, self._wired.volts(sent)
        clipped = valve.clipped
        if not valve.accept(voltage, arrival):
            self.get_logger().warning(f"valve command {voltage} refused", throttle_duration_sec=5.0)
        elif valve.clipped > clipped:
            self.get_logger().warning(
                f"valve command {voltage:g} V clipped to {valve.max_voltage:g} V", throttle_duration_sec=5.0
            )

    def _push(self, message: bytes) -> None:
        force, first = readers.number(message), not self.simulation.force.accepted
        if not self.simulation.force.accept(force):
            self.get_logger().warning(f"external force {force} N refused", throttle_duration_sec=5.0)
        elif first:
            self._description.publish()  # from now on a recording needs the measured load

    # --- what it says -----------------------------------------------------------------------------------------------

    def health(self) -> Health:
        """Rates, counts and warnings; see `Monitor`."""
        return self._monitor.look(self.engine.paused, self.engine.fault, self._tuning.compiler.busy)

    def _describe(self) -> dict[str, object]:
        wired = self.parameters["wired_as"]
        told = describe(self.simulation.described.as_dict(), self.parameters["seed"])
        return {**told, "wired_as": wired} if wired else told
