"""A machine designed from what a user says of it in words."""

from collections.abc import Mapping
from dataclasses import dataclass

from pneumo_ros.errors import UsageError
from pneumo_ros.parts import wishes
from pneumo_ros.parts.assemble import assemble, effects_of, full_signal
from pneumo_ros.parts.order import ATMOSPHERE, DIMENSIONS, REGULATOR, Order, of_parts, order_of
from pneumo_ros.parts.quantity import parse, pressure
from pneumo_ros.parts.shelf import Shelf
from pneumo_ros.plant import Model
from pneumo_ros.plant.effects.frame.air import Air

SWITCHED = 1.0  # V from closed, beyond which a switched valve has its full flow


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

    @property
    def least(self) -> float:
        """The lowest signal [V] that the valve of chamber a takes: a regulator's is 0 V."""
        return 0.0 if self.order.ways == REGULATOR else self.signal[1]

    @property
    def commands(self) -> str:
        """What commands do, in words: each kind of valve has its own."""
        high, low = self.signal
        if self.order.ways == REGULATOR:
            bar = self.model["pressure_regulator.pressure_range"] / 1e5
            return (
                f"0 to {high:g} V are 0 to {bar:.3g} bar gauge in chamber a by valve/command, in chamber b by "
                "valve_b/command; the rod extends where a is stronger; 0 V empties"
            )
        if self.order.ways == "2/2":
            return (
                f"{high:g} V fills chamber a and empties b without pause (extends), {low:g} V the other way; between, "
                "in pulses; all valves closed at 0 V"
            )
        if self.order.ways:
            return (
                f"{high:g} V keeps chamber a filling and b emptying (extends), {low:g} V the other way; between, in "
                "turn, half of each period at 0 V; these valves never close both ways"
            )
        if self.order.switched:
            above, below = self.closed + SWITCHED, self.closed - SWITCHED
            return (
                f"above {above:g} V extends and below {below:g} V retracts, at full flow; closed at {self.closed:g} V"
            )
        return f"{high:g} V extends, {low:g} V retracts at full opening; closed at {self.closed:g} V"


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
        supply=_of_air(pressure(said.supply, "the supply", ATMOSPHERE)),
        mass=parse(said.mass, "mass", "the mass", plain="kg", example="10kg"),
        tilt=wishes.tilt(said.mounting),
        ways="" if valve is None else REGULATOR if valve.kind == REGULATOR else valve.ways,
    )
    read_as = wishes.read_as(said.sensors)
    made = assemble(order, name)
    return Design(made.model, made.notes, made.sources, order, full_signal(order), read_as, tuple(_cautions(order)))


def _of_air(supply: float) -> float:
    """The supply pressure [Pa]; UsageError for one that is of oil."""
    most = Air.parameters["supply_pressure"].high
    if supply > most:
        raise UsageError(
            f"the supply is {1e-5 * supply:.4g} bar absolute; a machine file has up to {1e-5 * most:.4g} bar, of air. "
            "Of a cylinder that oil moves, friction and load alone are judged, driven by both pressures: give --supply "
            "6barg and any --valve-flow, which then count for nothing, and --read-as no-command with its recordings"
        )
    return supply


def _cautions(order: Order) -> list[str]:
    """Sentences on what the machine leaves open and its user has to know."""
    found = []
    if closed := order.nominal.get("signal_closed", 0.0):
        found.append(
            f"the valve is closed at {closed:g} V, and 0 V moves the piston: start simulator, controller and "
            "experiments with this machine file, which close it there, and keep pressure away from the rig while "
            "anything else commands it"
        )
    if order.ways and order.ways != REGULATOR:
        found.append(
            "set pulse_frequency and phase to those of the driver, or pulse_frequency 0 where the command itself "
            "switches"
        )
    if not order.ways and "valve_spool_dynamics" not in effects_of(order):
        found.append("nothing is known of how fast the valve follows: valve_spool_dynamics is left out")
    return found
