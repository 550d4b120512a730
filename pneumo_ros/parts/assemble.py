"""A machine from figures: values of its parameters, how uncertain they are, and where each comes from."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from pneumo_ros.parts import flow
from pneumo_ros.parts.figure import GIVEN, Figure
from pneumo_ros.parts.order import ATMOSPHERE, REGULATOR, Order
from pneumo_ros.parts.quantity import GRAVITY
from pneumo_ros.plant import Library, Model
from pneumo_ros.plant.effects.valve.choked_flow import ELLIPSE, NORMAL_DENSITY, ratio_function

RISE = 2.67  # omega t at which a lag with damping ratio 0.7 has gone 90 % of the way
FASTEST = 1000.0  # rad/s, the largest that `valve_spool_dynamics` takes: no lag
LEVEL = 1e-3  # rad: an axis tilted by less has no load
UNSTATED = (  # no recording shows them: a fit leaves them alone
    "lugre_friction.bristle_damping", "arctan_flow.filling_coefficient", "arctan_flow.exhaust_coefficient",
    "on_off_valves.pulse_frequency",
)  # fmt: skip
_LIMITS = ("dead_zone.right_limit", "dead_zone.left_limit")
_PROBE = 0.01  # share of a figure by which it is changed to see what depends on it


@dataclass(frozen=True)
class Assembled:
    """A machine, and a note for each of its parameters: where its value comes from, [1] for the first of `sources`."""

    model: Model
    notes: Mapping[str, str]
    sources: tuple[str, ...]


def assemble(order: Order, name: str = "new", library: Library | None = None) -> Assembled:
    """The machine that the figures of `order` make; UsageError where one leaves the range of its parameter.

    The uncertainty of a parameter is the root of the sum of squares of the changes by every figure's deviation.
    """
    nominal = order.nominal
    values = parameters(order, nominal)
    uncertain: dict[str, float] = {}
    for key, figure in order.figures.items():
        if figure.deviation > 0.0:
            moved = parameters(order, nominal | {key: figure.value + figure.deviation})
            for dotted, value in values.items():
                uncertain[dotted] = math.hypot(uncertain.get(dotted, 0.0), moved[dotted] - value)
    stated = {n: std for n, std in uncertain.items() if std > 1e-9 * abs(values[n]) and n not in UNSTATED}
    effects = effects_of(order)
    library = library or Library()
    model = Model.build(effects, values, name=name, library=library, defaults=True, uncertainty=stated)
    behind = _behind(order, values)
    sources = tuple(dict.fromkeys(_source(figure) for found in behind.values() for figure in found if _cited(figure)))
    notes = {
        dotted: ", ".join(dict.fromkeys(_reference(f, sources) for f in found)) for dotted, found in behind.items()
    }
    return Assembled(model, notes, sources)


def effects_of(order: Order) -> list[str]:
    """The effects of the machine, in order."""
    spool = not order.ways and _frequency(order.nominal)
    valve = [
        *(["valve_null_offset"] if _closed(order.nominal) else []),
        *(["valve_spool_dynamics"] if spool else []),
        *(["dead_zone"] if _proportional(order) else []),
    ]
    if order.ways:
        behind = ["pressure_regulator", "second_regulator"] if order.ways == REGULATOR else ["on_off_valves"]
    else:
        behind = []
    ratios = ["path_critical_ratios"] if _excess(order.nominal) else []
    load = ["constant_load"] if abs(order.nominal["tilt"]) > LEVEL else []
    return [
        *valve,
        "arctan_flow",
        "choked_flow",
        *ratios,
        *behind,
        "rod_atmospheric_force",
        *load,
        "lugre_friction",
        "end_stop",
    ]


def parameters(order: Order, figure: Mapping[str, float]) -> dict[str, float]:
    """Values by dotted name for the given values of figures; those not listed keep the defaults of their effects."""
    area_a = math.pi / 4.0 * figure["bore"] ** 2
    area_b = area_a - math.pi / 4.0 * figure["rod"] ** 2
    share = 0.5 + figure["dead_volume"]
    sliding = figure["friction"] * area_a * (figure["supply"] - ATMOSPHERE)
    breakaway = figure["breakaway"] * sliding
    found = {
        "piston.mass": figure["mass"],
        "piston.area_a": area_a,
        "piston.area_b": area_b,
        "piston.stroke": figure["stroke"],
        "air.supply_pressure": figure["supply"],
        "chambers.volume_a": area_a * figure["stroke"] * share,
        "chambers.volume_b": area_b * figure["stroke"] * share,
        **_flow(order, figure),
        **(dict.fromkeys(_LIMITS, figure["overlap"] * _reach(order)) if _proportional(order) else {}),
        "lugre_friction.static_friction": breakaway,
        "lugre_friction.coulomb_friction": sliding,
        "lugre_friction.stribeck_velocity": figure["stribeck_velocity"],
        "lugre_friction.bristle_stiffness": breakaway / figure["deflection"],
        "lugre_friction.bristle_damping": figure["seal_damping"] * breakaway,
    }
    if abs(order.nominal["tilt"]) > LEVEL:
        found["constant_load.load"] = figure["mass"] * GRAVITY * math.sin(figure["tilt"])
    if _closed(order.nominal):
        found["valve_null_offset.offset"] = -_closed(figure)
    if excess := _excess(order.nominal):
        found["path_critical_ratios.exhaust_excess"] = _excess(figure) or excess
    if order.ways:
        return found | (_regulator(figure) if order.ways == REGULATOR else _pulses(order, figure))
    if omega := _frequency(figure):
        found["valve_spool_dynamics.angular_frequency"] = min(omega, FASTEST)
        found["valve_spool_dynamics.damping_ratio"] = figure["spool_damping"]
    return found


def _pulses(order: Order, figure: Mapping[str, float]) -> dict[str, float]:
    """On/off valves by their switching times; the published rate of switching is that of their pulses."""
    of = {
        "switch_on": figure.get("switch_on", figure["switching_time"]) * figure["switching"],
        "switch_off": figure.get("switch_off", figure["switching_time"]) * figure["switching"],
        "pulse_frequency": figure.get("switching_rate", figure["pulse_frequency"]),
        "three_way": 1.0 if order.ways == "3/2" else 0.0,
        "full_signal": figure["full_signal"],
        "travel": figure["travel"],
    }
    return {f"on_off_valves.{name}": value for name, value in of.items()}


def _regulator(figure: Mapping[str, float]) -> dict[str, float]:
    """A regulator; where no range is published, full signal asks for the supply."""
    reach = figure.get("pressure_high", figure["supply"] - ATMOSPHERE)
    of = {
        "pressure_range": reach,
        "full_signal": figure.get("signal_high", figure["full_signal"]),
        "angular_frequency": RISE / figure.get("response", figure["regulator_response"]),
        "damping_ratio": figure["spool_damping"],
        "dead_band": figure.get("dead_band", figure["regulator_dead_band"]),
        "band": figure["regulator_band"] * reach,
    }
    return {f"pressure_regulator.{name}": value for name, value in of.items()}


def _excess(figure: Mapping[str, float]) -> float:
    """Critical pressure ratio of the exhaust paths above that of the filling paths; 0 where one is not published."""
    filling, exhaust = figure.get("critical_ratio_filling"), figure.get("critical_ratio_exhaust")
    return exhaust - filling if filling is not None and exhaust is not None else 0.0


def full_signal(order: Order) -> tuple[float, float]:
    """Signals [V] at which the valve is fully open: to extend, and to retract."""
    figure = order.nominal
    if "signal_high" in figure and "signal_low" in figure:
        return figure["signal_high"], figure["signal_low"]
    return _closed(figure) + figure["full_signal"], _closed(figure) - figure["full_signal"]


def _flow(order: Order, figure: Mapping[str, float]) -> dict[str, float]:
    """ISO 6358 flow through an opening that reaches the published C at full signal."""
    b = figure["critical_ratio"]
    filling, exhaust = _conductances(order, figure)
    reach = _reach(order) * (1.0 - (figure["overlap"] if _proportional(order) else 0.0))
    gain = figure["switched_gain"] if order.switched and not order.ways else figure["linearity"] / reach
    whole = 0.5 * math.pi / math.atan(gain * reach)  # C at an infinite signal over C at the full one
    before, behind = flow.NOMINAL
    line = NORMAL_DENSITY * before * ratio_function(behind / before, b, ELLIPSE) / (before - behind) * 2.0 / math.pi
    return {
        "arctan_flow.filling_coefficient": filling * whole * line,
        "arctan_flow.exhaust_coefficient": exhaust * whole * line,
        "arctan_flow.voltage_gain": gain,
        "choked_flow.conductance_filling": filling * whole,
        "choked_flow.conductance_exhaust": exhaust * whole,
        "choked_flow.critical_ratio": b,
    }


def _proportional(order: Order) -> bool:
    """Whether one spool opens in proportion to the signal, beyond its overlap."""
    return not order.ways and not order.switched


def _reach(order: Order) -> float:
    """Signal [V] from closed to fully open."""
    return max(abs(end - _closed(order.nominal)) for end in full_signal(order))


def _conductances(order: Order, figure: Mapping[str, float]) -> tuple[float, float]:
    """C [m3/(s Pa)] of the filling and the exhaust edge."""
    b, size = figure["critical_ratio"], figure[order.flow]
    of = {"nominal_flow": flow.of_nominal_flow, "kv": flow.of_kv, "cv": flow.of_cv}
    filling = of[order.flow](size, b) if order.flow in of else size
    exhaust = figure.get("conductance_exhaust", filling)
    return filling * figure["filling_scatter"], exhaust * figure["exhaust_scatter"]


def _closed(figure: Mapping[str, float]) -> float:
    return figure.get("signal_closed", 0.0)


def _frequency(figure: Mapping[str, float]) -> float:
    """Angular frequency of the spool [rad/s] by its bandwidth or its switching times; 0 where neither is known."""
    if "bandwidth" in figure:
        return 2.0 * math.pi * figure["bandwidth"] / figure["switching"]
    times = [figure[name] for name in ("switch_on", "switch_off") if name in figure]
    return RISE / (figure["switching"] * sum(times) / len(times)) if times else 0.0


def _behind(order: Order, values: Mapping[str, float]) -> dict[str, list[Figure]]:
    """The figures that change each value, rules last."""
    found: dict[str, list[Figure]] = {dotted: [] for dotted in values}
    for key, figure in sorted(order.figures.items(), key=lambda item: bool(item[1].rule)):
        moved = parameters(order, order.nominal | {key: figure.value * (1.0 + _PROBE)})
        for dotted, value in values.items():
            if moved[dotted] != value:
                found[dotted].append(figure)
    return {dotted: figures for dotted, figures in found.items() if figures}


def _cited(figure: Figure) -> bool:
    return figure.source != GIVEN


def _source(figure: Figure) -> str:
    return f"rule {figure.rule}: {figure.source}" if figure.rule else figure.source


def _reference(figure: Figure, sources: tuple[str, ...]) -> str:
    if not _cited(figure):
        return figure.source
    number = f"[{sources.index(_source(figure)) + 1}]"
    return f"rule {figure.rule} {number}" if figure.rule else number
