"""Actuators: the part of a machine that makes force of air, and the chambers that it has.

An actuator is an effect of the folder `effects/actuator`, named in a machine file by its section. It has a state `p_a`
or `p_b` for each of its chambers. The other side of its piston is open: for effects it is a chamber without end at the
pressure of the atmosphere, into which nothing flows.
"""

from dataclasses import dataclass
from typing import ClassVar

from pneumo_ros.plant.effect import Effect

SIDES = {"a": 1.0, "b": -1.0}  # side -> 1 where its volume grows with the position, -1 where it shrinks
# what effects read of an open side, by their names with the side in braces
_OPEN = {
    "p_{}": "p_atm", "volume_{}": "1000.0", "valve_flow_{}": "0.0", "port_flow_{}": "0.0", "flow_{}": "0.0",
    "added_volume_{}": "0.0", "heat_{}": "0.0", "touched_{}": "1.0",
}  # fmt: skip


@dataclass(frozen=True)
class Chamber:
    """A chamber of an actuator: its side, "a" or "b", and by which names it is known."""

    part: str  # section of its volume in the machine file
    side: str

    @property
    def way(self) -> float:
        """1 where its volume grows with the position, -1 where it shrinks."""
        return SIDES[self.side]

    @property
    def state(self) -> str:
        """Its pressure among the states."""
        return f"p_{self.side}"

    @property
    def signal(self) -> str:
        """Its measured pressure, by its name in runs and reports."""
        return f"pressure_{self.side}_pa"

    @property
    def field(self) -> str:
        """The same in recordings."""
        return f"pressure_{self.side}"

    @property
    def equation(self) -> str:
        """Its mass balance, by its name in reports."""
        return f"chamber_{self.side}"

    @property
    def topic(self) -> str:
        """The topic of its sensor."""
        return f"chamber_{self.side}/pressure"

    @property
    def flow(self) -> str:
        """The mass flow through its port, among the observed signals."""
        return f"port_flow_{self.side}"

    @property
    def area(self) -> str:
        """The parameter of its area."""
        return f"piston.area_{self.side}"

    @property
    def volume(self) -> str:
        """The parameter of its volume at mid stroke."""
        return f"{self.part}.volume_{self.side}"


class Actuator(Effect):
    """Base of all actuators; subclasses are never instantiated.

    `outputs` of an actuator gives the walls that the gas touches, over those at mid stroke, as `touched_a` and
    `touched_b`: it alone knows their shape. A chamber of one cross-section A with the circumference U has
    S = 2 A + (U / A) V, both ends and the walls along the way (geometry).
    """

    chambers: ClassVar[tuple[Chamber, ...]] = ()
    open_side: ClassVar[dict[str, str]] = {}  # name -> constant or signal that takes its place

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls.chambers = tuple(Chamber(cls.name, side) for side in SIDES if f"p_{side}" in cls.states)
        absent = [side for side in SIDES if f"p_{side}" not in cls.states]
        cls.open_side = {name.format(side): value for side in absent for name, value in _OPEN.items()}
