"""~/reset, ~/pause and ~/step."""

from typing import TYPE_CHECKING

from std_srvs.srv import SetBool, Trigger

if TYPE_CHECKING:
    from pneumo_ros.ros.simulator.node import Simulator


class Services:
    """The services of a simulator."""

    def __init__(self, node: "Simulator") -> None:
        """Offer them below the node's own name."""
        self._node = node
        node.create_service(Trigger, "~/reset", self._reset)
        node.create_service(SetBool, "~/pause", self._pause)
        node.create_service(Trigger, "~/step", self._step)

    def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        node = self._node
        with node.lock:
            node.simulation.reset()
            if node.fault:
                node.fault, node.paused = None, False
        node.get_logger().info("reset to the initial state")
        response.success, response.message = True, "at the initial state, valve closed"
        self._resume()
        return response

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        node = self._node
        if node.fault and not request.data:
            response.success, response.message = False, f"{node.fault}; call ~/reset first"
            return response
        node.paused = request.data
        response.success, response.message = True, "paused" if request.data else "running"
        if not request.data:
            self._resume()
        return response

    def _step(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        node = self._node
        if node.coupling:
            response.success, response.message = False, "the simulator that sends coupled/joint_states makes the steps"
            return response
        if not node.paused or node.fault:
            response.success, response.message = False, node.fault or "running; call ~/pause with data: true first"
            return response
        with node.lock:
            node.single_step()
        response.success = not node.fault
        response.message = node.fault or f"at {node.simulation.time:.6g} s"
        return response

    def _resume(self) -> None:
        if self._node.lockstep and not self._node.paused:
            self._node.lockstep.resume()
