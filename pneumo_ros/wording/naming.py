"""Names of equations within sentences, lists of names, and numbers with their uncertainty."""

import math
from collections.abc import Sequence

from pneumo_ros.compare.wording import EQUATIONS, number

NORMAL = 1.96  # standard deviations on either side that hold 95 %


def equation_words(name: str) -> str:
    """`chamber_a` as 'chamber a'; `name` may also be breakaway, valve or sensor."""
    return EQUATIONS[name][0] if name in EQUATIONS else name.replace("_", " ")


def the(equation: str) -> str:
    """`equation_words` within a sentence: 'the momentum equation', 'the equation of chamber a', 'the valve'."""
    words = equation_words(equation)
    if equation not in EQUATIONS:
        return f"the {words}"
    return f"the equation of {words}" if words.startswith("chamber") else f"the {words} equation"


def listed(words: Sequence[str], last: str = "and") -> str:
    """'a', 'a and b', 'a, b and c'; 'nothing' where there is none."""
    *first, end = words or ("nothing",)
    return f"{', '.join(first)} {last} {end}" if first else end


def counted(number: int, thing: str) -> str:
    """'1 run', '3 runs'."""
    return f"{number} {thing}" + ("" if number == 1 else "s")


def sentence(text: str) -> str:
    """The text with a capital first letter."""
    return text[:1].upper() + text[1:]


def resolved(value: float, std: float) -> str:
    """A value with as many decimals as its standard deviation allows; ends of an interval get as many."""
    if not (math.isfinite(std) and std > 0.0):
        return number(value)
    decimals = max(-math.floor(math.log10(std / 2.0)), 0)
    if decimals <= 6:
        return f"{value:.{decimals}f}"
    return number(value, max(math.ceil(math.log10(max(abs(value) / std, 1.0))) + 1, 2))


def interval(value: float, std: float, least: float = -math.inf, most: float = math.inf) -> str:
    """The 95 % interval of a value within its allowed range, or 'not determined'."""
    if not math.isfinite(std):
        return "not determined"
    low, high = max(value - NORMAL * std, least), min(value + NORMAL * std, most)
    return f"{resolved(low, std)} to {resolved(high, std)}"


def change(before: float, after: float) -> str:
    """The change of an error: '-93 %', '+4 %', '2.5 times as much', or 'no change' below one per cent."""
    ratio = after / before if before > 0.0 else math.nan
    if not math.isfinite(ratio):
        return ""
    if ratio >= 2.0:
        return f"{number(ratio, 2)} times as much"
    return "no change" if abs(ratio - 1.0) < 0.01 else f"{100.0 * (ratio - 1.0):+.0f} %"
