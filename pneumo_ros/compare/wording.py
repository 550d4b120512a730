"""Names of signals, equations, regimes and variables in texts, and numbers as text. Plain Python only."""

import math
from collections.abc import Iterator, Mapping

from pneumo_ros.units import shown

Row = tuple[str, str, float]


class Named(Mapping[str, Row]):
    """Name in reports -> words, unit shown, factor from SI, in the units of the machine that texts are about."""

    def __init__(self, rows: Mapping[str, Row]) -> None:
        self._rows = dict(rows)

    def __getitem__(self, name: str) -> Row:
        words, unit, factor = self._rows[name]
        return words, shown(unit), factor

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)


_SIGNALS = {
    "position_m": ("position", "mm", 1e3),
    "pressure_a_pa": ("pressure a", "kPa", 1e-3),
    "pressure_b_pa": ("pressure b", "kPa", 1e-3),
    "force_n": ("force", "N", 1.0),
    "flow_a_kg_s": ("flow a", "mg/s", 1e6),
}
_EQUATIONS = {
    "momentum": ("momentum", "N", 1.0),
    "chamber_a": ("chamber a", "mg/s", 1e6),
    "chamber_b": ("chamber b", "mg/s", 1e6),
}
SIGNALS, EQUATIONS, TARGETS = Named(_SIGNALS), Named(_EQUATIONS), Named(_SIGNALS | _EQUATIONS)
REGIMES = {
    "stick": "stick",
    "breakaway": "breakaway",
    "slide": "slide",
    "reversal": "reversal",
    "near_end_stop": "near the end stops",
    "filling_a": "filling a",
    "exhausting_a": "exhausting a",
    "filling_b": "filling b",
    "exhausting_b": "exhausting b",
    "valve_near_null": "valve near null",
}
VARIABLES = Named({
    "velocity": ("velocity", "m/s", 1.0),
    "position": ("position", "m", 1.0),
    "voltage": ("voltage", "V", 1.0),
    "force": ("driving force", "N", 1.0),
    "pressure_a": ("pressure a", "bar", 1e-5),
    "pressure_b": ("pressure b", "bar", 1e-5),
    "pressure_difference": ("pressure a - b", "bar", 1e-5),
    "time": ("time", "s", 1.0),
})  # fmt: skip


def number(value: float | None, digits: int = 3) -> str:
    """A number of `digits` significant digits, without exponent where it stays short; a dash for none."""
    if value is None or not math.isfinite(value):
        return "-"
    text = f"{value:.{digits}g}"
    if "e" in text and 1e-4 <= abs(value) < 1e6:
        text = f"{value:.{max(digits - 1 - math.floor(math.log10(abs(value))), 0)}f}"
    return text


def amount(value: float | None, target: str) -> str:
    """A value in SI units as text: 0.00034 of position_m is '0.34 mm'."""
    _, unit, factor = TARGETS[target]
    return "-" if value is None else f"{number(factor * value)} {unit}"


def times(ratio: float | None) -> str:
    """A ratio to the noise: '14 x', '1.2 x'."""
    if ratio is None or not math.isfinite(ratio):
        return "-"
    return f"{ratio:.1f} x" if ratio < 9.95 else f"{number(ratio, 3 if ratio >= 100 else 2)} x"


def percent(share: float | None) -> str:
    """A share as whole per cent."""
    if share is None or not math.isfinite(share):
        return "-"
    return f"{100.0 * share:.0f} %" if share >= 0.01 or share == 0.0 else "< 1 %"
