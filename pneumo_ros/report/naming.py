"""How a diagnosis is worded: names of effects and equations, lists of them, numbers with their uncertainty."""

import math
from collections.abc import Sequence

from pneumo_ros.compare.wording import EQUATIONS, number

NORMAL = 1.96  # deviations that hold 95 %


def effect_words(name: str) -> str:
    """`viscous_friction` as people say it."""
    return name.replace("_", " ")


def equation_words(name: str) -> str:
    """`chamber_a` as people say it; also what a diagnosis judges besides equations: breakaway, valve, sensor."""
    return EQUATIONS[name][0] if name in EQUATIONS else name.replace("_", " ")


def the(equation: str) -> str:
    """`equation_words` within a sentence: 'the momentum', 'chamber a'."""
    words = equation_words(equation)
    return words if words.startswith("chamber") else f"the {words}"


def listed(words: Sequence[str], last: str = "and") -> str:
    """'a', 'a and b', 'a, b and c'."""
    *first, end = words or ("nothing",)
    return f"{', '.join(first)} {last} {end}" if first else end


def sentence(text: str) -> str:
    """With a capital letter, the rest as it is."""
    return text[:1].upper() + text[1:]


def resolved(value: float, std: float) -> str:
    """A value to the decimal that its standard deviation leaves certain; an interval's ends get as many decimals."""
    if not (math.isfinite(std) and std > 0.0):
        return number(value)
    decimals = max(-math.floor(math.log10(std / 2.0)), 0)
    if decimals <= 6:
        return f"{value:.{decimals}f}"
    return number(value, max(math.ceil(math.log10(max(abs(value) / std, 1.0))) + 1, 2))


def interval(value: float, std: float, least: float = -math.inf, most: float = math.inf) -> str:
    """The 95 % interval of a value within what is allowed, or that there is none."""
    if not math.isfinite(std):
        return "not determined by these recordings"
    low, high = max(value - NORMAL * std, least), min(value + NORMAL * std, most)
    return f"{resolved(low, std)} to {resolved(high, std)}"


def change(before: float, after: float) -> str:
    """What became of an error: '-93 %', '+4 %', '2.5 times as much', or 'no change' below one per cent."""
    ratio = after / before if before > 0.0 else math.nan
    if not math.isfinite(ratio):
        return ""
    if ratio >= 2.0:
        return f"{number(ratio, 2)} times as much"
    if abs(ratio - 1.0) < 0.01:
        return "no change"
    return f"{100.0 * (ratio - 1.0):+.0f} %".replace("-", "\N{MINUS SIGN}")
