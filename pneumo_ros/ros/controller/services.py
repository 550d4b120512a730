"""~/stop, ~/hold, ~/vent and ~/resume."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from std_srvs.srv import Trigger

from pneumo_ros.errors import UsageError

if TYPE_CHECKING:
    from pneumo_ros.ros.controller.node import Controller


class Services:
    """The explicit commands of a controller; references are followed again after ~/resume."""

    def __init__(self, node: "Controller") -> None:
        """Offer them below the node's own name."""
        self._node = node
        guide = node.loop.guide
        self._offer("stop", self._stop, "the valve is closed")
        self._offer("hold", lambda: guide.hold(node.loop_now()), "the piston is brought to rest and held there")
        self._offer("vent", lambda: guide.vent(node.loop_now()), "the chambers are being emptied")
        self._offer("resume", lambda: guide.resume(node.loop_now()), "references are followed again")

    def _stop(self) -> None:
        self._node.loop.guide.stop()
        self._node.send(0.0)  # at once, before the next measurement

    def _offer(self, name: str, act: Callable[[], None], done: str) -> None:
        def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            try:
                act()
            except UsageError as error:
                response.success, response.message = False, str(error)
            else:
                response.success, response.message = True, done
                self._node.get_logger().info(f"{name}: {done}")
            return response

        self._node.create_service(Trigger, f"~/{name}", answer)
