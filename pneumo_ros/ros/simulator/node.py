"""The simulator: the plant as a node."""

import threading
import time
from collections.abc import Callable, Iterable
from pathlib import Path

from std_msgs.msg import Float64

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.priority import take_priority
from pneumo_ros.axis.roles import PLANT
from pneumo_ros.axis.simulator.coupled import Coupled
from pneumo_ros.axis.simulator.health import Monitor
from pneumo_ros.axis.simulator.lockstep import WATCH, Lockstep
from pneumo_ros.axis.simulator.machine import machine_from_parameters
from pneumo_ros.axis.simulator.sensors import Sensors
from pneumo_ros.axis.simulator.settings import EFFECTS, FIXED, LIVE, effects_setting, machine_settings
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.simulator.stamps import WallStamps
from pneumo_ros.axis.simulator.valve_input import ValveInput
from pneumo_ros.axis.ticker import Ticker
from pneumo_ros.errors import NumericalError
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.records.contract import COMMAND, COMMAND_B, FORCE
from pneumo_ros.records.corrections import parse_words, wiring
from pneumo_ros.ros import readers
from pneumo_ros.ros.description import Description, describe
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.peers import loop_closed
from pneumo_ros.ros.qos import RELIABLE, SUBSCRIBE
from pneumo_ros.ros.rivals import Rivals
from pneumo_ros.ros.simulator.coupling import Coupling
from pneumo_ros.ros.simulator.outlet import Outlet
from pneumo_ros.ros.simulator.services import Services
from pneumo_ros.ros.simulator.tuning import Tuning, initial_state


class Simulator(AxisNode):
    """Steps the machine in real time or in lockstep, takes `valve/command`, sends sensor readings."""

    def __init__(
        self, effects_files: Iterable[str | Path] = (), tolerated: Callable[[str], bool] = lambda name: False
    ) -> None:
        """Raises UsageError for an unknown effect or parameter, unless it is `tolerated`, for a bad value, and where
        there is another plant.
        """
        super().__init__("simulator", [*FIXED, *LIVE], simulated_time=False)  # it is the source of that time
        self.rivals = Rivals(self, PLANT)
        files = tuple(effects_files)
        self.lock = threading.Lock()
        self.paused = self.parameters["start_paused"]
        self.fault: str | None = None
        self.simulation = self._build(files, tolerated)
        self.rivals.settle()
        coupled = self.parameters["coupled"]  # the clock is that of the other side
        self._simulated_time = self.parameters["publish_clock"] or self.parameters["real_time_factor"] != 1.0 or coupled
        self._wired = wiring(parse_words(self.parameters["wired_as"]))
        joint, chambers = self.parameters["joint_name"], self.simulation.model.chambers
        self.outlet = Outlet(self, joint, self._simulated_time and not coupled, self._wired, chambers)
        self._stamps = WallStamps()
        self._description = Description(self, self._describe)
        self._tuning = Tuning(
            self.parameters, self.simulation, self.lock, self.get_logger(), self._description.publish, files
        )
        self._service_calls = Services(self)
        # before that of chamber a: of two commands that have both arrived, it is read first
        self.create_subscription(Float64, COMMAND_B, self._command_b, SUBSCRIBE, raw=True)
        self._commands = self.create_subscription(Float64, COMMAND, self._command, SUBSCRIBE, raw=True)
        self.create_subscription(Float64, FORCE, self._push, RELIABLE, raw=True)
        self.coupling = Coupling(self, self.simulation) if isinstance(self.simulation, Coupled) else None
        factor = self.parameters["real_time_factor"]
        self._period = 1e9 / self.simulation.rate / (factor or 1.0)  # ns of wall time
        self.lockstep = self._make_lockstep() if factor == 0.0 and not self.coupling else None
        self._ticker = None if self.lockstep or self.coupling else self._make_ticker()
        self._monitor = Monitor(self.simulation, self._ticker or self.lockstep)

    # --- construction -----------------------------------------------------------------------------------------------

    def _build(self, files: tuple[str | Path, ...], tolerated: Callable[[str], bool]) -> Simulation:
        values = self.parameters
        values.refuse_unknown(lambda name: tolerated(name) or "." in name or name == EFFECTS)
        given = {name: value for name, value in values.given.items() if not tolerated(name)}
        model = machine_from_parameters(values["model"], given, files)
        values.declare([effects_setting(model), *machine_settings(model, list(model.parameters))])
        model.state(**initial_state(values.values()))
        for sentence in model.cautions():
            self.get_logger().warning(sentence)
        valve = ValveInput(values["max_voltage"], values["command_timeout"], closed_signal(model))
        sensors = Sensors(seed=values["seed"])
        kind = Coupled if values["coupled"] else Simulation
        return kind(model, valve, sensors, rate=values["publish_rate"], step=values["step"])

    def _make_ticker(self) -> Ticker:
        return Ticker(self._period, self._tick, self.fail)

    def _make_lockstep(self) -> Lockstep:
        lockstep = Lockstep(
            lambda: self._advance(0, 1.0),
            self._send,
            lambda: loop_closed(self, self.outlet.joint_states, self._commands),
            lambda: self.paused,
            lambda act: self.executor.create_task(act),
            self.get_logger(),
            wait=self.parameters["lockstep_wait"],
            timeout=self.parameters["lockstep_timeout"],
        )
        self.create_timer(WATCH, lockstep.watch, clock=self.steady_clock)
        return lockstep

    # --- life -------------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin at the initial state."""
        self.simulation.reset()
        if self._ticker:
            self._ticker.start()
            take_priority(self.parameters["real_time_priority"])  # after the start: new threads do not inherit it

    def ready(self) -> str:
        """The machine and its rate."""
        model = self.simulation.model
        return f"ready: {model.name} with {len(model.effects)} effects, joint_states at {self.simulation.rate:g} Hz"

    def finish(self) -> None:
        """Stop the plant."""
        self.paused = True
        if self._ticker:
            self._ticker.stop()

    def simulated_clock(self) -> int:
        """Simulated time [ns]."""
        return self.simulation.clock

    def single_step(self) -> None:
        """One sample while paused; with the lock held."""
        now = time.monotonic_ns()
        if self.lockstep:
            if self._advance(0, 1.0):
                self.lockstep.publish()
        elif self._advance(round(now - self._period), self._period / self.simulation.plant.parts):
            self._send(now)

    def _tick(self, deadline: int) -> None:
        """The sample that ends at `deadline` [ns, CLOCK_MONOTONIC] is over: simulate it."""
        begin, part = round(deadline - self._period), self._period / self.simulation.plant.parts
        with self.lock:
            if not self.paused and self._advance(begin, part):
                self._send(deadline)

    def _advance(self, begin: int, part: float) -> bool:
        """One sample, see `Simulation.advance`; False, and a pause, if the state is not finite."""
        try:
            self.simulation.advance(begin, part)
        except NumericalError as error:
            self.fault, self.paused = str(error), True
            self.get_logger().error(f"{error}; paused: call ~/reset, or change a parameter first")
        return self.fault is None

    def send(self) -> None:
        """Send the present sample, stamped with the simulation's time."""
        self._send()

    def _send(self, moment: int = 0) -> None:
        """Send the present sample, stamped with simulated time or the wall time of `moment` [ns, CLOCK_MONOTONIC]."""
        stamp = self.simulation.clock if self._simulated_time else self._stamps.at(moment)
        self.outlet.send(self.simulation, stamp)

    def _command(self, message: bytes) -> None:
        self._take(self.simulation.valve, readers.number(message))
        if self.lockstep:
            self.lockstep.command()

    def _command_b(self, message: bytes) -> None:
        """The command of the valve of chamber b; in lockstep it comes before that of chamber a, which goes on."""
        valve = self.simulation.valve_b
        if valve in self.simulation.valves:
            self._take(valve, readers.number(message))
        else:
            name = self.simulation.model.name
            self.get_logger().warning(f"{COMMAND_B} is not used: {name} has one command", throttle_duration_sec=10.0)

    def _take(self, valve: ValveInput, sent: float) -> None:
        arrival, voltage = time.monotonic_ns() if self._ticker else 0, self._wired.volts(sent)
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
        return self._monitor.look(self.paused, self.fault, self._tuning.compiler.busy)

    def _describe(self) -> dict[str, object]:
        wired = self.parameters["wired_as"]
        told = describe(self.simulation.described.as_dict(), self.parameters["seed"])
        return {**told, "wired_as": wired} if wired else told
