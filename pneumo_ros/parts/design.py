"""A machine designed from what a user says of it in words."""

from collections.abc import Mapping
from dataclasses import dataclass

from pneumo_ros.parts import wishes
from pneumo_ros.parts.assemble import assemble, effects_of, full_signal
from pneumo_ros.parts.order import ATMOSPHERE, DIMENSIONS, REGULATOR, Order, of_parts, order_of
from pneumo_ros.parts.quantity import parse, pressure
from pneumo_ros.parts.shelf import Shelf
from pneumo_ros.plant import Model


@dataclass(frozen=True)
class Wishes:
    """What a machine is to be, as text; None where the user says nothing."""

    supply: str
    mass: str
    cylinder: str | None = None
    bore: str | None = None
    rod: str | None = None
    stroke: str | None = None
    valve: str | None = None
    valve_flow: str | None = None
    signal: str | None = None
    mounting: str = "horizontal"
    sensors: str = "absolute-Pa"


@dataclass(frozen=True)
class Design:
    """A machine, where each value comes from, and how to use it.

    signal: volts at which it extends and retracts at full opening; read_as: words of --read-as for its sensors.
    """

    model: Model
    notes: Mapping[str, str]
    sources: tuple[str, ...]
    order: Order
    signal: tuple[float, float]
    read_as: str
    cautions: tuple[str, ...]

    @property
    def closed(self) -> float:
        """Signal [V] at which the valve is closed."""
        return self.order.nominal.get("signal_closed", 0.0)


def design(said: Wishes, shelf: Shelf, name: str = "new") -> Design:
    """The machine of a user's words; UsageError, with what is allowed, for anything that makes none."""
    cylinder, stroke = shelf.cylinder(said.cylinder) if said.cylinder else (None, None)
    valve = shelf.find(said.valve, "valve", "regulator") if said.valve else None
    sizes = {"stroke": stroke} if stroke is not None else {}
    for one in DIMENSIONS:
        if (text := getattr(said, one)) is not None:
            sizes[one] = parse(text, "length", f"the {one}", plain="mm", example="250, or 250mm")
    flow = dict(wishes.flow(said.valve_flow)) if said.valve_flow else {}
    flow |= wishes.signal(said.signal) if said.signal else {}
    barrel, ports, opening = of_parts(cylinder, valve, sizes, flow)
    order = order_of(
        barrel,
        ports,
        opening=opening,
        supply=pressure(said.supply, "the supply", ATMOSPHERE),
        mass=parse(said.mass, "mass", "the mass", plain="kg", example="10kg"),
        tilt=wishes.tilt(said.mounting),
        ways="" if valve is None else REGULATOR if valve.kind == REGULATOR else valve.ways,
    )
    read_as = wishes.read_as(said.sensors)
    made = assemble(order, name)
    return Design(made.model, made.notes, made.sources, order, full_signal(order), read_as, tuple(_cautions(order)))


def _cautions(order: Order) -> list[str]:
    """Sentences on what the machine leaves open and its user has to know."""
    found = []
    if closed := order.nominal.get("signal_closed", 0.0):
        found.append(
            f"the valve is closed at {closed:g} V, and 0 V moves the piston: start simulator, controller and "
            "experiments with this machine file, which close it there, and keep pressure away from the rig while "
            "anything else commands it"
        )
    if order.ways == REGULATOR:
        found.append(
            "each chamber has a regulator: valve/command is the pressure of chamber a, valve_b/command that of chamber "
            "b, 0 to 10 V for the whole range, and 0 V empties"
        )
    elif order.ways:
        found.append(
            "commands become pulses of the valves, whose share of a period follows the command, half of it at 0 V; set "
            "pulse_frequency and phase to those of the driver, or pulse_frequency 0 where the command itself switches"
        )
    elif order.switched:
        found.append(
            "this is a switched valve: any command above 1 V extends at full flow, any below -1 V retracts, 0 V closes"
        )
    if not order.ways and "valve_spool_dynamics" not in effects_of(order):
        found.append("nothing is known of how fast the valve follows: valve_spool_dynamics is left out")
    return found
