"""The controller: one valve command per joint state."""

import threading
import time
from collections.abc import Callable
from functools import partial

from rclpy.duration import Duration
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64

from pneumo_ros.control import Law
from pneumo_ros.records.contract import COMMAND, JOINT_STATES, PRESSURE_A, PRESSURE_B
from pneumo_ros.ros import messages, readers
from pneumo_ros.ros.controller.loop import Loop
from pneumo_ros.ros.controller.settings import (
    LAWS,
    SETTINGS,
    absent,
    gains_of,
    machine_of,
    of_a_machine_file,
    reference_of,
    valve_of,
)
from pneumo_ros.ros.diagnostics import Health
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.parameters import Values
from pneumo_ros.ros.priority import take_priority
from pneumo_ros.ros.qos import PUBLISH, SUBSCRIBE

REFERENCE = "position/reference"
CHECK = 0.02  # s between looks for silence


class Controller(AxisNode):
    """Follows `position/reference` or a built-in reference; sends 0 V when measurements stay away, and at the end."""

    def __init__(
        self, tolerated: Callable[[str], bool] = lambda name: False, clock: Callable[[], int] | None = None
    ) -> None:
        """`clock` [ns] tells how long measurements stay away; None: simulated time if used, else the steady clock.

        Raises UsageError for an unknown parameter, unless it is `tolerated` or a machine file's, or a bad value.
        """
        super().__init__("controller", SETTINGS)
        values = self.parameters
        values.update(absent(values.begun_with))
        foreign = of_a_machine_file(values.begun_with)
        values.refuse_unknown(lambda name: name in foreign or tolerated(name))
        self._joint, self._law = values["joint_name"], values["law"]
        self.loop = Loop(self._make_law(values.values()), reference_of(values.values()), values["measurement_timeout"])
        values.check, values.apply = self._check, self._apply
        self._clock_ns = clock or (self._simulated if values.uses_simulated_time else time.monotonic_ns)
        self._heard: int | None = None  # when the last measurement came
        self._stale = self._finished = False
        self._sending = threading.Lock()
        self._publisher, self._message = self.create_publisher(Float64, COMMAND, PUBLISH), messages.number()
        self._listen()

    def _listen(self) -> None:
        self._reader = readers.JointReader(self._joint)
        self.create_subscription(JointState, JOINT_STATES, self._joint_states, SUBSCRIBE, raw=True)
        for chamber, topic in (("a", PRESSURE_A), ("b", PRESSURE_B)) if self.loop.law.reads_pressures else ():
            self.create_subscription(FluidPressure, topic, partial(self._pressure, chamber), SUBSCRIBE, raw=True)
        self.create_subscription(Float64, REFERENCE, self._reference, SUBSCRIBE)
        self.create_timer(CHECK, self._watch, clock=self.steady_clock)

    def _simulated(self) -> int:
        """While the plant pauses, this time does so, too: no silence."""
        return int(self.get_clock().now().nanoseconds)

    # --- parameters -------------------------------------------------------------------------------------------------

    def _make_law(self, values: Values) -> Law:
        return LAWS[values["law"]](gains_of(values["law"], values), valve_of(values), machine_of(values))

    def _check(self, values: Values) -> None:
        self._make_law(values)
        reference_of(values)

    def _apply(self, changed: Values) -> None:
        values = {**self.parameters.values(), **changed}
        self.loop.law.tune(gains_of(self._law, values))
        self.loop.law.valve, self.loop.law.machine = valve_of(values), machine_of(values)
        self.loop.timeout = values["measurement_timeout"]
        if any(name.startswith("reference.") for name in changed):
            self.loop.reference = reference_of(values)

    # --- topics -----------------------------------------------------------------------------------------------------

    def _joint_states(self, data: bytes) -> None:
        sample = self._reader.read(data)
        if sample is None:
            self._miss_joint(data)
            return
        now = self._clock_ns()
        voltage = self.loop.measure(sample.stamp or now, sample.position, sample.velocity)
        if voltage is not None:
            self._heard, self._stale = now, self._recovered()
            self._send(voltage)

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
        self.loop.pressures[chamber] = readers.pressure(data)

    def _reference(self, message: Float64) -> None:
        if self.loop.reference is None and not self.loop.want(message.data):
            self.get_logger().warning(f"reference {message.data} refused", throttle_duration_sec=5.0)

    def _watch(self) -> None:
        """0 V, again and again, while no measurement comes."""
        if self._heard is None or self._clock_ns() - self._heard < self.loop.timeout * 1e9:
            return
        if not self._stale:
            self._stale = True
            self.get_logger().warning(f"no measurement for {self.loop.timeout:g} s: sending 0 V")
        self._send(0.0)

    def _send(self, voltage: float) -> None:
        with self._sending:
            if not self._finished:
                self._publisher.publish(self._message.fill(0, voltage))

    # --- life -------------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Nothing to begin, but everything to answer in time. In lockstep there is no hurry."""
        if self._clock_ns is time.monotonic_ns:
            take_priority(self.parameters["real_time_priority"])

    def finish(self) -> None:
        """0 V is the last command."""
        self._send(0.0)
        with self._sending:
            self._finished = True
        self._publisher.wait_for_all_acked(Duration(seconds=0.2))

    def health(self) -> Health:
        """Counts, errors and what is missing."""
        loop = self.loop
        values: dict[str, object] = {"measurements": loop.measured, "rejected_inputs": loop.refused}
        values |= {"saturated_commands": loop.saturated, "restarts": loop.restarts, "voltage_V": loop.voltage}
        if self._heard is not None:
            values["measurement_age_s"] = (self._clock_ns() - self._heard) * 1e-9
        if loop.wanted is not None and loop.position is not None:
            values["position_error_m"] = loop.wanted.position - loop.position
        missing = "no measurement yet" if self._heard is None else "measurements stay away: sending 0 V"
        warnings = [missing] if self._heard is None or self._stale else []
        if loop.wanted is None:
            warnings.append("no reference yet: holding 0 V")
        return Health(values, warnings)
