"""~/reset, ~/pause and ~/step."""

from std_srvs.srv import SetBool, Trigger

from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.simulator.together import Together
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.simulator.engine import Engine


class Reset:
    """~/reset of one axis, or of all that an engine moves."""

    def __init__(self, node: AxisNode, engine: Engine, plant: Simulation | Together) -> None:
        """`plant` is what goes back to its initial state."""
        self._node, self._engine, self._plant = node, engine, plant
        node.create_service(Trigger, "~/reset", self._reset)

    def _reset(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        engine = self._engine
        with engine.lock:
            self._plant.reset()
            if engine.fault:
                engine.fault, engine.paused = None, False
        self._node.get_logger().info("reset to the initial state")
        response.success, response.message = True, "at the initial state, valve closed"
        _go_on(engine)
        return response


class Services:
    """~/pause and ~/step of all that an engine moves."""

    def __init__(self, node: AxisNode, engine: Engine) -> None:
        """Offer them below the node's own name."""
        self._engine = engine
        node.create_service(SetBool, "~/pause", self._pause)
        node.create_service(Trigger, "~/step", self._step)

    def _pause(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        engine = self._engine
        if engine.fault and not request.data:
            response.success, response.message = False, f"{engine.fault}; call ~/reset first"
            return response
        engine.paused = request.data
        response.success, response.message = True, "paused" if request.data else "running"
        _go_on(engine)
        return response

    def _step(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        engine = self._engine
        if engine.driven:
            response.success, response.message = False, "the simulator that sends coupled/joint_states makes the steps"
            return response
        if not engine.paused or engine.fault:
            response.success, response.message = False, engine.fault or "running; call ~/pause with data: true first"
            return response
        with engine.lock:
            engine.single_step()
        response.success = not engine.fault
        response.message = engine.fault or f"at {engine.plant.time:.6g} s"
        return response


def _go_on(engine: Engine) -> None:
    if engine.lockstep and not engine.paused:
        engine.lockstep.resume()
