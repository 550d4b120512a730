"""Effects in a machine that turns: the same equations, with parameters and states in rad, N m and kg m2."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.effect import Effect, Parameter, State
from pneumo_ros.units import COORDINATES, KEY, LINE, ROTARY, TURN, unit_along

_RADII = (0.01, 1.0)  # m, of machines that turn: a range in rad and N m holds what one in m and N holds at any of them
_DIGITS = 2  # significant ones of defaults in rad and N m
_STEPS = (1.0, 2.0, 5.0, 10.0)  # in a decade: to which the scale of a machine is rounded


@dataclass(frozen=True)
class Scale:
    """How large a machine that turns is: its N m where the default machine has 1 N, and its rad for 1 m."""

    force: float = 0.1
    length: float = 1.0

    @classmethod
    def of(cls, values: Mapping[str, object], actuated: bool) -> "Scale":
        """From the machine's torque and stroke, `values` by dotted name, rounded to 1, 2 or 5 in a decade.

        The torque is the supply's on the vane, the motor's at rest, or else the static friction.
        """
        torque = _product(values, "air.supply_pressure", "piston.area_a") / (7e5 * 4.1e-4) if actuated else 0.0
        torque = torque or _product(values, "dc_motor.force_per_volt", "dc_motor.source_voltage") / 246.0
        torque = torque or _product(values, "lugre_friction.static_friction") / 100.0
        stroke = _product(values, "piston.stroke") / 2.0
        return cls(_rounded(torque or cls.force), _rounded(stroke or cls.length))


def _product(values: Mapping[str, object], *names: str) -> float:
    """Product of some values; 0 unless all are there and above 0 (what is wrong with them is said elsewhere)."""
    result = 1.0
    for name in names:
        value = values.get(name)
        result *= float(value) if isinstance(value, int | float) and 0.0 < value < 1e12 else 0.0
    return result


def _rounded(size: float) -> float:
    exponent = int(f"{size:.0e}".partition("e")[2])
    mantissa = size / 10.0**exponent
    return min(_STEPS, key=lambda step: abs(step / mantissa - 1.0)) * 10.0**exponent


def turned(effect: type[Effect], scale: Scale) -> type[Effect]:
    """The effect in a machine that turns: the same equations, its parameters and states in rad, N m and kg m2.

    Ranges are those in m and N at every radius of 10 mm to 1 m, defaults those of the default machine at the `scale`.
    """
    return _turned((effect, scale))


@lru_cache(maxsize=1024)
def _turned(given: tuple[type[Effect], Scale]) -> type[Effect]:
    """One class for each effect and scale, as models are compared by their effects."""
    effect, scale = given
    body = {key: value for key, value in vars(effect).items() if key not in ("__dict__", "__weakref__")}
    body |= {key: _parameter(one, scale) for key, one in effect.parameters.items()}
    body |= {key: _state(one) for key, one in effect.states.items()}
    made: type[Effect] = type(effect.__name__, effect.__bases__, body)
    return made


def _parameter(one: Parameter, scale: Scale) -> Parameter:
    if one.unit not in ROTARY:
        return one
    unit, force, length = ROTARY[one.unit]
    factors = [radius ** (force - length) for radius in _RADII]
    low, high = min(one.low * f for f in factors), max(one.high * f for f in factors)
    span = min(abs(one.high - one.low) * f for f in factors)
    size = scale.force**force * scale.length**length
    default = min(max(float(f"{one.default * size:.{_DIGITS}g}"), low), high)
    usual = None if one.usual is None else float(f"{one.usual * size:.{_DIGITS}g}")
    return replace(one, unit=unit, low=low, high=high, default=default, usual=usual, span=span)


def _state(one: State) -> State:
    return replace(one, unit=unit_along(one.unit, TURN), line_unit=one.unit)


def coordinate_of(given: object, parts: tuple[type[Effect], ...]) -> str:
    """The coordinate of a machine of these parts, whose file says `given`, or nothing.

    Raises UsageError for an unknown one, and for another than that of what actuates it.
    """
    if given is not None and given not in COORDINATES:
        if not isinstance(given, str):
            raise UsageError(f"'{KEY}' is {brief(given)}; it takes {' or '.join(COORDINATES)}")
        raise UsageError(unknown_name(KEY, given, COORDINATES))
    for part in parts:
        if part.coordinate and given not in (None, part.coordinate):
            raise UsageError(f"its part '{part.name}' is one for '{KEY}: {part.coordinate}', and the file says {given}")
    return str(given or next((part.coordinate for part in parts if part.coordinate), LINE))
