"""Whether a simulator of this package plays the rig: it claims the role of the plant, which a rig's driver does not."""

import json
from collections.abc import Callable

from std_msgs.msg import String

from pneumo_ros.axis.roles import PLANT
from pneumo_ros.errors import UsageError
from pneumo_ros.plant.closed import OFFSET, OFFSET_B
from pneumo_ros.records.contract import DESCRIPTION
from pneumo_ros.records.corrections import parse_words, wiring
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.qos import LATCHED
from pneumo_ros.ros.rivals import CLAIMS


class SimulatedRig:
    """Listens for a simulator in the namespace of `node`: its claim, and the machine that it describes."""

    def __init__(self, node: AxisNode, heard: Callable[[], None] = lambda: None) -> None:
        """`heard` is called when one is found."""
        self.closed: float | None = None  # [V] that closes its valve; None: none has described itself
        self.second_closed: float | None = None  # [V] the same of the valve of chamber b; None: there is none
        self._heard, self._claimed = heard, False
        node.create_subscription(String, f"claims/{PLANT.name}", self._claim, CLAIMS)
        node.create_subscription(String, DESCRIPTION, self._describe, LATCHED)

    @property
    def found(self) -> bool:
        """Whether there is one."""
        return self._claimed and self.closed is not None

    def _claim(self, message: String) -> None:
        self._claimed = True
        self._tell()

    def _describe(self, message: String) -> None:
        section, second = OFFSET.partition(".")[0], OFFSET_B.partition(".")[0]
        try:
            told = json.loads(message.data)
            wired, model = wiring(parse_words(told.get("wired_as", ""))), told["model"]
            closed, closed_b = (-float(model.get(name, {}).get("offset", 0.0)) for name in (section, second))
            self.closed = wired.command(closed) + 0.0  # never -0
            self.second_closed = wired.command(closed_b) + 0.0 if second in model["effects"] else None
        except (ValueError, TypeError, KeyError, AttributeError, UsageError):  # anybody may publish anything
            return
        self._tell()

    def _tell(self) -> None:
        if self.found:
            self._heard()
