"""A node in the test's own process: sends and hears everything, changes parameters, calls services."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParametersAtomically
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import FluidPressure, JointState
from std_msgs.msg import Float64, String
from std_srvs.srv import SetBool, Trigger

PATIENCE = 90.0  # s: a bound for what comes at once on an idle machine
LOCKED = 30.0  # s, after which a node that does not end has locked up
RELIABLE = QoSProfile(depth=5000, reliability=ReliabilityPolicy.RELIABLE)
BEST_EFFORT = QoSProfile(depth=5000, reliability=ReliabilityPolicy.BEST_EFFORT)
LEFT_BEHIND: list["Probe"] = []  # they would lock up the end of the process, too: `conftest` ends it without
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Probe:
    """Hears joint_states, pressures, commands, description and diagnostics of one namespace, in lists by topic."""

    def __init__(self, namespace: str = "", qos: QoSProfile = RELIABLE) -> None:
        self.context = Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node("probe", namespace=namespace, context=self.context)
        self.heard: dict[str, list[Any]] = {}
        for topic, kind, how in (
            ("joint_states", JointState, qos),
            ("chamber_a/pressure", FluidPressure, qos),
            ("chamber_b/pressure", FluidPressure, qos),
            ("valve/command", Float64, qos),
            ("description", String, LATCHED),
            ("/diagnostics", DiagnosticArray, RELIABLE),
        ):
            self.hear(topic, kind, how)
        self._publishers: dict[str, Any] = {}
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._closed = False
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        while not self._closed:
            self._executor.spin_once(timeout_sec=0.1)

    def hear(self, topic: str, kind: type, how: QoSProfile) -> list[Any]:
        """Subscribe; messages gather in the list returned."""
        messages = self.heard.setdefault(topic, [])
        self.node.create_subscription(kind, topic, messages.append, how)
        return messages

    def close(self) -> None:
        """End the node; where the middleware has locked up, leave it behind.

        Fast DDS 3.2 can: a writer removed elsewhere takes its lock and waits for the timer that is to announce this
        participant, which waits for the lock.
        """
        self._closed = True
        ending = threading.Thread(target=self._end, daemon=True)
        ending.start()
        ending.join(LOCKED)
        if ending.is_alive():
            LEFT_BEHIND.append(self)

    def _end(self) -> None:
        self._thread.join(LOCKED)
        self._executor.shutdown()
        self.node.destroy_node()
        self.context.shutdown()

    # --- waiting ----------------------------------------------------------------------------------------------------

    def wait(self, condition: Callable[[], object], what: str, seconds: float = PATIENCE) -> Any:
        """Wait until `condition` holds; its value."""
        end = time.monotonic() + seconds
        while not (value := condition()):
            assert time.monotonic() < end, f"in {seconds} s never: {what}"
            time.sleep(0.005)
        return value

    def matched(self, *publishers: Any) -> None:
        """Wait until each of `publishers` has a subscriber."""
        for publisher in publishers:
            self.wait(publisher.get_subscription_count, f"a subscriber of {publisher.topic_name}")

    def more(self, topic: str, count: int = 1) -> list[Any]:
        """The next `count` messages of a topic."""
        have = len(self.heard[topic])
        self.wait(lambda: len(self.heard[topic]) >= have + count, f"{count} more on {topic}")
        return self.heard[topic][have : have + count]

    def quiet(self, topic: str, seconds: float = 0.3) -> None:
        """Until nothing has come on a topic for so long."""

        def still() -> bool:
            have = len(self.heard[topic])
            time.sleep(seconds)
            return len(self.heard[topic]) == have

        self.wait(still, f"silence on {topic}")

    def health(self, name: str) -> tuple[str, dict[str, str]]:
        """Message and values of the next diagnostics of node `name` (with its namespace)."""
        begin = len(self.heard["/diagnostics"])

        def found() -> Any:
            new = [s for message in self.heard["/diagnostics"][begin:] for s in message.status if s.name == name]
            return new and new[-1]

        status = self.wait(found, f"diagnostics of {name}")
        return status.message, {pair.key: pair.value for pair in status.values}

    @property
    def command(self) -> Any:
        """Publisher of valve commands; created at first use."""
        return self._publisher("valve/command")

    @property
    def reference(self) -> Any:
        """Publisher of references."""
        return self._publisher("position/reference")

    def _publisher(self, topic: str) -> Any:
        if topic not in self._publishers:
            self._publishers[topic] = self.node.create_publisher(Float64, topic, 10)
        return self._publishers[topic]

    def withdraw(self) -> None:
        """End all publishers; the next use makes them again."""
        for publisher in self._publishers.values():
            self.node.destroy_publisher(publisher)
        self._publishers.clear()

    # --- acting -----------------------------------------------------------------------------------------------------

    def send(self, voltage: float, seconds: float = 0.0) -> None:
        """A command, every 10 ms for `seconds`."""
        end = time.monotonic() + seconds
        self.command.publish(Float64(data=voltage))
        while time.monotonic() < end:
            time.sleep(0.01)
            self.command.publish(Float64(data=voltage))

    def call(self, kind: type, service: str, request: Any) -> Any:
        """The answer of a service."""
        client = self.node.create_client(kind, service)
        assert client.wait_for_service(PATIENCE), service
        answer = client.call_async(request)
        self.wait(answer.done, f"an answer of {service}")
        self.node.destroy_client(client)
        return answer.result()

    def trigger(self, service: str) -> Any:
        """Answer of a std_srvs/Trigger."""
        return self.call(Trigger, service, Trigger.Request())

    def pause(self, on: bool) -> Any:
        """Answer of ~/pause."""
        return self.call(SetBool, "simulator/pause", SetBool.Request(data=on))

    def set(self, node: str, **values: object) -> tuple[bool, str]:
        """Set parameters, all at once (`__` in a name means a dot); whether it succeeded, and the reason if not."""
        given = [Parameter(name.replace("__", "."), value=value).to_parameter_msg() for name, value in values.items()]
        request = SetParametersAtomically.Request(parameters=given)
        result = self.call(SetParametersAtomically, f"{node}/set_parameters_atomically", request).result
        return result.successful, result.reason

    def get(self, node: str, name: str) -> Any:
        """Value of a parameter."""
        values = self.call(GetParameters, f"{node}/get_parameters", GetParameters.Request(names=[name])).values
        return parameter_value_to_python(values[0])

    def names(self, node: str) -> list[str]:
        """Names of all parameters."""
        return list(self.call(ListParameters, f"{node}/list_parameters", ListParameters.Request()).result.names)

    def describe(self, node: str, name: str) -> Any:
        """Descriptor of a parameter."""
        request = DescribeParameters.Request(names=[name])
        return self.call(DescribeParameters, f"{node}/describe_parameters", request).descriptors[0]


@contextmanager
def probe(namespace: str = "", qos: QoSProfile = RELIABLE) -> Iterator[Probe]:
    """A probe that ends with the block."""
    one = Probe(namespace, qos)
    try:
        yield one
    finally:
        one.close()


def stamp(message: JointState | FluidPressure) -> int:
    """Header stamp [ns]."""
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
