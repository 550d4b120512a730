"""~/stop, ~/close, ~/hold, ~/vent and ~/resume."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from std_srvs.srv import Trigger

from pneumo_ros.axis.controller.guide import Mode
from pneumo_ros.errors import UsageError

if TYPE_CHECKING:
    from pneumo_ros.ros.controller.node import Controller


class Services:
    """The explicit commands of a controller; references are followed again after ~/resume."""

    def __init__(self, node: "Controller") -> None:
        """Offer them below the node's own name."""
        self._node = node
        guide = node.loop.guide
        self._offer("stop", self._stop, "")
        self._offer("close", self._close, "the valve is closed; the piston coasts")
        self._offer("hold", lambda: guide.hold(node.loop_now()), "the piston is brought to rest and held there")
        self._offer("vent", lambda: guide.vent(node.loop_now()), "the chambers are being emptied")
        self._offer("resume", lambda: guide.resume(node.loop_now()), "references are followed again")

    def _stop(self) -> str:
        if self._node.stale:  # nothing to brake by
            return self._close() or "the valve is closed: measurements are missing, so the piston coasts"
        guide = self._node.loop.guide
        distance = guide.stop(self._node.loop_now())
        if guide.mode is Mode.STOPPED:
            self._node.send(0.0)
            return "the valve is closed"
        return f"braking: the piston rests after {1e3 * distance:.0f} mm, then the valve is closed"

    def _close(self) -> str:
        self._node.loop.guide.close()
        self._node.send(0.0)  # at once, before the next measurement
        return ""

    def _offer(self, name: str, act: Callable[[], str | None], said: str) -> None:
        def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            done = said
            try:
                done = act() or said
            except UsageError as error:
                response.success, response.message = False, str(error)
            else:
                response.success, response.message = True, done
                self._node.get_logger().info(f"{name}: {done}")
            return response

        self._node.create_service(Trigger, f"~/{name}", answer)
