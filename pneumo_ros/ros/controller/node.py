"""The controller: one valve command per joint state; requests arrive through `inputs` and `services`."""

import threading
import time
from collections.abc import Callable
from functools import partial

from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pneumo_ros.axis.controller.guiding import set_guide
from pneumo_ros.axis.controller.health import Growth, health_of
from pneumo_ros.axis.controller.loop import Loop
from pneumo_ros.axis.controller.settings import (
    OF_THE_MACHINE,
    SETTINGS,
    absent,
    check,
    gains_of,
    law_of,
    machine_of,
    of_a_machine_file,
    of_a_rig,
    reference_of,
    valve_of,
    wired_by,
)
from pneumo_ros.axis.health import Health
from pneumo_ros.axis.priority import take_priority
from pneumo_ros.axis.roles import CONTROLLER
from pneumo_ros.axis.sections import of_axis, with_arm
from pneumo_ros.records.contract import COMMAND, COMMAND_B, JOINT_STATES, PRESSURE_A, PRESSURE_B
from pneumo_ros.ros import messages, readers
from pneumo_ros.ros.controller.action import Following, FollowJointTrajectory
from pneumo_ros.ros.controller.inputs import Inputs
from pneumo_ros.ros.controller.services import Services
from pneumo_ros.ros.controller.setpoints import Setpoints
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.parameters import Values
from pneumo_ros.ros.qos import ACKNOWLEDGED, PUBLISH, SUBSCRIBE
from pneumo_ros.ros.rivals import Rivals
from pneumo_ros.ros.simulated import SimulatedRig

CHECK = 0.02  # s between checks for missing measurements


class Controller(AxisNode):
    """Follows received references or a built-in one; closes the valve when measurements are missing, and at the end.

    It sends nothing while neither a file, a parameter nor a simulated plant says which signal closes the valve.
    """

    def __init__(
        self,
        tolerated: Callable[[str], bool] = lambda name: False,
        clock: Callable[[], int] | None = None,
        simulated: bool = False,
    ) -> None:
        """`clock` [ns] measures how long measurements are missing; None: simulated time if used, else the steady clock.
        `simulated`: a simulator plays the rig, in this process.

        Raises UsageError for an unknown parameter, unless it is `tolerated` or a machine file's, for a bad value, and
        where there is another controller.
        """
        super().__init__("controller", SETTINGS)
        self.rivals = Rivals(self, CONTROLLER)
        values = self.parameters
        values.update(absent(values.begun_with))
        values.update(of_a_rig(values.values(), values.begun_with))
        foreign = of_a_machine_file(values.begun_with)
        values.refuse_unknown(lambda name: name in foreign or tolerated(name))
        self._joint, self._law = values["joint_name"], values["law"]
        check(values.values())
        self._rig = wired_by(values.values(), values.begun_with)
        self._plant = None if simulated or self._rig.declared else SimulatedRig(self)
        self.loop = Loop(law_of(values.values()), values["measurement_timeout"])
        self.loop.guide.built_in = reference_of(values.values())
        set_guide(self.loop.guide, values.values(), 0.0)
        values.check, values.apply = check, self._apply
        self._clock_ns = clock or (self._simulated if values.uses_simulated_time else time.monotonic_ns)
        self._heard: int | None = None  # when the last measurement came
        self._stamp = 0  # of the last measurement
        self._stale = self._finished = False
        self._growth, self._told = Growth(), ""
        self._sending = threading.Lock()
        self.rivals.settle()
        self._publisher, self._message = self.create_publisher(Float64, COMMAND, PUBLISH), messages.number()
        self._second = self.create_publisher(Float64, COMMAND_B, PUBLISH) if self._has_second() else None
        self._setpoints = Setpoints(self, self._joint)
        self._listen()
        self.inputs, self._service_calls = Inputs(self, self._joint), Services(self)
        self._action = Following(self, FollowJointTrajectory) if FollowJointTrajectory else None

    def chosen(self, given: Values) -> Values:
        """Of a machine of several axes, the parameters of the one whose name ends the namespace."""
        own = {one.name for one in SETTINGS} - OF_THE_MACHINE
        return with_arm(of_axis(given, self.get_namespace(), own, "controller"))

    def _listen(self) -> None:
        self._reader = readers.JointReader(self._joint)
        self.create_subscription(JointState, JOINT_STATES, self._joint_states, SUBSCRIBE, raw=True)
        for chamber, topic in (("a", PRESSURE_A), ("b", PRESSURE_B)) if self.loop.law.reads_pressures else ():
            self.create_subscription(FluidPressure, topic, partial(self._pressure, chamber), SUBSCRIBE, raw=True)
        self.create_timer(CHECK, self._watch, clock=self.steady_clock)

    def _simulated(self) -> int:
        """Simulated time [ns]; it pauses with the plant, so that no measurement seems to be missing."""
        return int(self.get_clock().now().nanoseconds)

    # --- time -------------------------------------------------------------------------------------------------------

    def _since(self) -> int:
        """Time [ns] since the last measurement, at most the timeout."""
        if self._heard is None:
            return 0
        return min(max(self._clock_ns() - self._heard, 0), round(self.loop.timeout * 1e9))

    def loop_now(self) -> float:
        """The present time of the control loop [s]."""
        return self.loop.time + self._since() * 1e-9

    def stamp_now(self) -> int:
        """The present time [ns] on the clock of the measurements' stamps; ROS's where they have none."""
        return self._stamp + self._since() if self._stamp else self.get_clock().now().nanoseconds

    # --- parameters -------------------------------------------------------------------------------------------------

    def _apply(self, changed: Values) -> None:
        values, loop = {**self.parameters.values(), **changed}, self.loop
        loop.law.tune(gains_of(self._law, values))
        loop.law.valve, loop.law.machine = valve_of(values), machine_of(values)
        self._rig = wired_by(values, self.parameters.begun_with)
        loop.timeout = values["measurement_timeout"]
        set_guide(loop.guide, values, self.loop_now())
        if any(name.startswith("reference.") for name in changed):
            loop.guide.built_in = reference_of(values)

    # --- topics -----------------------------------------------------------------------------------------------------

    def _joint_states(self, data: bytes) -> None:
        sample = self._reader.read(data)
        if sample is None:
            self._miss_joint(data)
            return
        now = self._clock_ns()
        wired = self._rig.wiring
        position, velocity = wired.position(sample.position), wired.velocity(sample.velocity)
        voltage = self.loop.measure(sample.stamp or now, position, velocity)
        if voltage is not None:
            self._heard, self._stamp, self._stale = now, sample.stamp, self._recovered()
            self.send(voltage)
            self._complain()
            self._setpoints.tell(self.loop.wanted, self.loop.time, self.stamp_now())

    def _complain(self) -> None:
        """Log once why a position is not believed."""
        if self.loop.fault and not self._told:
            self.get_logger().error(f"{self.loop.fault}: {self.closing}")
        self._told = self.loop.fault

    def _recovered(self) -> bool:
        if self._stale:
            self.get_logger().info("measurements are back")
        return False

    def _miss_joint(self, data: bytes) -> None:
        self.get_logger().warning(
            f"joint_states has no position of joint '{self._joint}' (parameter joint_name), but of: "
            f"{', '.join(self._reader.names(data)) or 'none'}",
            throttle_duration_sec=10.0,
        )

    def _pressure(self, chamber: str, data: bytes) -> None:
        self.loop.press(self._rig.wiring.chamber(chamber), self.absolute(readers.pressure(data)))

    def absolute(self, read: float) -> float:
        """Absolute pressure [Pa] of what a sensor of the rig sends."""
        return self._rig.wiring.pressure(read, self.loop.law.machine.atmospheric_pressure)

    def _watch(self) -> None:
        """Send 0 V repeatedly while no measurement comes. After a clock was set back, time counts from there."""
        if self._heard is None:
            return
        self._heard = min(self._heard, self._clock_ns())
        if self._clock_ns() - self._heard < self.loop.timeout * 1e9:
            return
        if not self._stale:
            self._stale = True
            self.get_logger().warning(f"no measurement for {self.loop.timeout:g} s: {self.closing}")
        self.send(None)

    def send(self, voltage: float | None) -> None:
        """Send a valve command, `voltage` [V] counted from the closed signal, None for the rig's safe state.

        Where each chamber has a valve, that of chamber b moves against it. Nothing is sent after `finish`, and while
        nobody has said which signal closes the valve.
        """
        if refusal := self._refusal():
            self.get_logger().error(refusal, throttle_duration_sec=10.0)
            return
        machine = self.loop.law.machine
        with self._sending:
            if self._finished:
                return
            if self._second:  # first, as the command of chamber a lets a plant in lockstep go on
                against = None if voltage is None else -voltage
                self._second.publish(self._message.fill(0, self._sent(machine.second_closed or 0.0, against)))
            self._publisher.publish(self._message.fill(0, self._sent(machine.closed_signal, voltage)))

    def _sent(self, closed: float, voltage: float | None) -> float:
        """The command [V] for a valve that is closed at `closed` [V]; None: for the safe state."""
        return self._rig.safe(closed) if voltage is None else self._rig.command(closed + voltage)

    def _has_second(self) -> bool:
        return self.loop.law.machine.second_closed is not None

    def _refusal(self) -> str:
        """Why no command may be sent; empty if one may."""
        if self._plant is None:
            return ""
        machine, simulated = self.loop.law.machine, self._plant.closed if self._plant.found else None
        found = self._rig.refusal(machine.closed_signal, simulated)
        if found or machine.second_closed is None or self._plant.second_closed is None:
            return found
        return self._rig.refusal(machine.second_closed, self._plant.second_closed)

    @property
    def closing(self) -> str:
        """What happens where it is not safe to move, for messages."""
        return f"sending {self._rig.safe(self.loop.law.machine.closed_signal):g} V"

    # --- life -------------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Ask for real-time scheduling, which lockstep does not need."""
        if self._clock_ns is time.monotonic_ns:
            take_priority(self.parameters["real_time_priority"])

    def ready(self) -> str:
        """The law and the joint."""
        closed = self._rig.command(self.loop.law.machine.closed_signal)
        return (
            f"ready: {self._law} moves joint '{self._joint}', valve closed at {closed:g} V; it waits for joint_states"
        )

    def finish(self) -> None:
        """The closed signal is the last command."""
        self.send(None)
        with self._sending:
            self._finished = True
        for publisher in filter(None, (self._second, self._publisher)):
            publisher.wait_for_all_acked(ACKNOWLEDGED)

    @property
    def stale(self) -> bool:
        """Whether measurements are missing."""
        return self._stale

    def health(self) -> Health:
        """See `health_of`."""
        age = None if self._heard is None else (self._clock_ns() - self._heard) * 1e-9
        found = health_of(self.loop, self.inputs.refused, age, self._stale)
        found.warnings += self._growth.warnings(self.loop)
        if refusal := self._refusal():
            found.errors.append(refusal)
        return found
