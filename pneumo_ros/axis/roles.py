"""Roles that one node of a namespace can have, and claims to them."""

from typing import NamedTuple

from pneumo_ros.records.contract import COMMAND, JOINT_STATES, PRESSURE_A, PRESSURE_B


class Role(NamedTuple):
    """A role that one node of a namespace can have; topic names are relative."""

    name: str
    topics: tuple[str, ...]  # only the node with this role publishes these
    shared: tuple[str, ...] = ()  # others may publish these for other joints


PLANT = Role("plant", (PRESSURE_A, PRESSURE_B), (JOINT_STATES,))
CONTROLLER = Role("controller", (COMMAND,))


class Claim(NamedTuple):
    """Who has a role since when [ns, system clock]; of two claims the smaller one wins."""

    since: int
    key: str  # random: two nodes may have the same name and, in theory, the same time
    node: str
