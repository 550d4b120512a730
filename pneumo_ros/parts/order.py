"""What a machine is to be made of: every figure by name, from parts, from the user, or from rules."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from pneumo_ros.errors import UsageError
from pneumo_ros.parts.figure import Figure, given
from pneumo_ros.parts.part import Part
from pneumo_ros.parts.shelf import rules

ATMOSPHERE = 1e5  # Pa
FLOWS = ("conductance_filling", "nominal_flow", "kv", "cv")  # figures that give the size of a valve, the best first
REGULATOR = "regulator"
DIMENSIONS = ("bore", "rod", "stroke")


@dataclass(frozen=True)
class Order:
    """Figures by name, whether the valve is `switched`, which figure gives its `flow` (one of FLOWS), and `ways`.

    ways: of on/off valves (one of `part.WAYS`), REGULATOR where each chamber has a pressure regulator, else empty.
    """

    figures: Mapping[str, Figure]
    switched: bool
    flow: str
    ways: str = ""

    @property
    def nominal(self) -> dict[str, float]:
        """The value of every figure."""
        return {name: figure.value for name, figure in self.figures.items()}


def order_of(
    cylinder: Mapping[str, Figure],
    valve: Mapping[str, Figure],
    *,
    opening: str,
    supply: float,
    mass: float,
    tilt: float,
    ways: str = "",
) -> Order:
    """The order of a cylinder (bore, rod, stroke), a valve (figures of `part.VALVE`) and its use.

    supply: absolute pressure [Pa]; mass [kg]; tilt [rad]: of the axis against the horizon, above 0 where the rod lifts
    the load as it extends. UsageError for sizes that fit no cylinder, and for a valve without a figure of its flow.
    """
    use = {"supply": given(supply, "Pa"), "mass": given(mass, "kg"), "tilt": given(tilt, "rad")}
    _check(cylinder, supply, mass, tilt)
    flow = next((name for name in FLOWS if name in valve), None)
    if flow is None:
        raise UsageError(
            "no flow of the valve is published here; give that of its data sheet: --valve-flow 'qn 700 l/min' "
            "(or C, Kv, Cv)"
        )
    known = {**rules(), **_valve(valve, flow), **{name: cylinder[name] for name in DIMENSIONS}, **use}
    if ways and ways != REGULATOR:  # open or closed: its flow is the published one, however it opens
        known["linearity"] = _exact(known["linearity"])
    return Order(known, opening == "switched", flow, ways)


def of_parts(
    cylinder: Part | None, valve: Part | None, sizes: Mapping[str, float], flow: Mapping[str, Figure]
) -> tuple[dict[str, Figure], dict[str, Figure], str]:
    """Figures of cylinder and valve, and how the valve opens: those of the parts, replaced by what the user gives."""
    barrel = dict(cylinder.figures if cylinder else {}) | {name: given(size, "m") for name, size in sizes.items()}
    absent = [name for name in DIMENSIONS if name not in barrel]
    if absent:
        raise UsageError(
            f"the {' and '.join(absent)} of the cylinder {'is' if len(absent) == 1 else 'are'} missing; "
            "give --cylinder iso15552-32-250 (see: pneumo parts), or --bore 32 --rod 12 --stroke 250, in mm"
        )
    own = {n: f for n, f in (valve.figures if valve else {}).items() if not (set(flow) & set(FLOWS) and _of_flow(n))}
    return barrel, own | dict(flow), valve.opening if valve else "proportional"


def _of_flow(name: str) -> bool:
    return name in FLOWS or name.startswith(("conductance", "critical_ratio"))


def _valve(valve: Mapping[str, Figure], flow: str) -> dict[str, Figure]:
    """Figures of the valve that a machine takes, with the rules' intervals where none is published."""
    known, scatter = dict(valve), rules()["data_sheet_flow"]
    for edge in ("filling", "exhaust"):
        known[f"{edge}_scatter"] = scatter if known.get(f"conductance_{edge}", known[flow]).exact else _exact(scatter)
    ratios = [known[name] for name in ("critical_ratio_filling", "critical_ratio_exhaust") if name in known]
    if ratios:
        values, ends = [f.value for f in ratios], [end for f in ratios for end in (f.low, f.high)]
        known["critical_ratio"] = replace(ratios[0], value=sum(values) / len(values), low=min(ends), high=max(ends))
    return known


def _exact(figure: Figure) -> Figure:
    return replace(figure, low=figure.value, high=figure.value)


def _check(cylinder: Mapping[str, Figure], supply: float, mass: float, tilt: float) -> None:
    bore, rod, stroke = (cylinder[name].value for name in DIMENSIONS)
    if not 0.0 < rod < bore or not stroke > 0.0:
        raise UsageError(
            f"bore {1e3 * bore:g} mm, rod {1e3 * rod:g} mm and stroke {1e3 * stroke:g} mm make no cylinder; "
            "the rod is thinner than the bore, and all are above 0; give --bore, --rod and --stroke in mm"
        )
    if supply <= ATMOSPHERE:
        raise UsageError(
            f"the supply is {supply / 1e5:g} bar absolute; it takes more than the atmosphere's 1 bar, such as 6barg"
        )
    if not mass > 0.0:
        raise UsageError(f"the mass is {mass:g} kg; it takes the moving mass, above 0, such as --mass 10kg")
    if not abs(tilt) <= math.pi / 2.0 + 1e-9:
        raise UsageError(f"the mounting is {math.degrees(tilt):g} deg; it takes -90 to 90 deg, such as 30deg")
