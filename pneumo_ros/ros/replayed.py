"""Recorded valve commands that are played: not at a rig of which nobody has said which signal closes its valve."""

from collections.abc import Iterable, Mapping
from typing import Any

from pneumo_ros.axis.rig import AS_PARAMETER, live_rig
from pneumo_ros.axis.roles import PLANT
from pneumo_ros.records.contract import COMMAND, COMMAND_B, split
from pneumo_ros.ros import messages
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.outputs import Outputs
from pneumo_ros.ros.simulated import SimulatedRig

UNDECLARED = f"a rig is there, and the recording holds commands of its valve: {AS_PARAMETER}; or leave {COMMAND} out: "
LEAVE_OUT = "-p topics:=\"['*joint_states', '*pressure']\""


class ReplayedCommands:
    """The command topics that a player plays, and whether it may."""

    def __init__(self, node: AxisNode, outputs: Outputs, topics: Iterable[str], values: Mapping[str, Any]) -> None:
        """`topics` as recorded; `values`: parameters of the rig."""
        self._node, self._outputs = node, outputs
        self._topics = [
            one for one in topics if one in outputs and (found := split(one)) and found[1] in (COMMAND, COMMAND_B)
        ]
        self._rig = live_rig({**values, "read_as": ""}, 0.0, said=False)
        self._closed = self._rig.wiring.command(0.0) if self._rig.declared else None
        self._simulated = SimulatedRig(node) if self._topics and not self._rig.declared else None

    def refusal(self) -> str:
        """Why the commands may not be played now; empty if they may."""
        simulated = self._simulated
        if simulated is None or simulated.found or not any(map(self._rig_beside, self._topics)):
            return ""
        return UNDECLARED + LEAVE_OUT

    def _rig_beside(self, topic: str) -> bool:
        """Whether another node sends the pressures that belong to a command topic."""
        place = self._outputs.name(topic).removesuffix(COMMAND).removesuffix(COMMAND_B)
        own = self._node.get_name(), self._node.get_namespace()
        infos = [one for name in PLANT.topics for one in self._node.get_publishers_info_by_topic(place + name)]
        return any((one.node_name, one.node_namespace) != own for one in infos)

    def close(self) -> None:
        """Where somebody has said which signal closes the valve, that is the last command."""
        if self._closed is None:
            return
        payload = messages.number().fill(0, self._rig.safe(0.0))
        for topic in self._topics:
            self._outputs.send(topic, payload)
