"""Sets parameters of another node, all or none of them."""

import time
from collections.abc import Callable, Mapping
from typing import Any

from rcl_interfaces.srv import ListParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.task import Future

from pneumo_ros.nearest import unknown_name
from pneumo_ros.ros.node import AxisNode

WAIT = 5.0  # s, for the node to be found, and for each of its answers
LOOK = 0.1  # s

Done = Callable[[bool, str], None]


class Target:
    """Calls a node by name, first for a list of its parameters; answers come through callbacks of the executor."""

    def __init__(self, node: AxisNode) -> None:
        """`node` makes the calls."""
        self._node = node
        self._name = ""
        self._values: Mapping[str, float] = {}
        self._done: Done | None = None  # while there is something to do
        self._clients: dict[str, Any] = {}
        self._question: tuple[str, Any, Callable[[Any], None]] | None = None  # service, request, handler of the answer
        self._future: Future | None = None
        self._deadline = 0.0
        node.create_timer(LOOK, self._look, clock=node.steady_clock)

    def set(self, name: str, values: Mapping[str, float], done: Done) -> None:
        """Set `values` on the node `name`; `done` receives success, and the reason of a failure."""
        if self._done is not None:
            self._end(False, "a newer result has come")
        self._drop()
        self._name, self._values, self._done = name, values, done
        kinds = {"list_parameters": ListParameters, "set_parameters_atomically": SetParametersAtomically}
        self._clients = {key: self._node.create_client(kind, f"{name}/{key}") for key, kind in kinds.items()}
        self._ask("list_parameters", ListParameters.Request(), self._compare)

    def _ask(self, service: str, request: Any, then: Callable[[Any], None]) -> None:
        self._question, self._future = (service, request, then), None
        self._deadline = time.monotonic() + WAIT

    def _look(self) -> None:
        """Call the service when it exists; handle its answer when it arrives."""
        if self._done is None or self._question is None:
            self._drop()
            return
        service, request, then = self._question
        if self._future is not None and self._future.done():
            then(self._future.result())
        elif self._future is None and self._clients[service].service_is_ready():
            self._future = self._clients[service].call_async(request)
        elif time.monotonic() > self._deadline:
            said = "is not there" if self._future is None else "does not answer"
            self._end(False, f"{self._name} {said} within {WAIT:g} s")

    def _compare(self, answer: Any) -> None:
        there = set(answer.result.names)
        lacking = [name for name in self._values if name not in there]
        if lacking:
            self._end(False, f"{self._name} lacks {', '.join(lacking)}: {unknown_name('parameter', lacking[0], there)}")
            return
        given = [Parameter(key, value=value).to_parameter_msg() for key, value in self._values.items()]
        request = SetParametersAtomically.Request(parameters=given)
        self._ask(
            "set_parameters_atomically", request, lambda said: self._end(said.result.successful, said.result.reason)
        )

    def _end(self, successful: bool, reason: str) -> None:
        done, self._done, self._question = self._done, None, None
        assert done is not None
        done(successful, reason)

    def _drop(self) -> None:
        for client in self._clients.values():
            self._node.destroy_client(client)
        self._clients, self._future = {}, None
