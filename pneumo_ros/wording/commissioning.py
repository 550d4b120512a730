"""A commissioning in words, from its JSON: what terminal and report share."""

from typing import Any

from pneumo_ros.compare.wording import number
from pneumo_ros.wording.naming import interval, resolved


def times(error: float | None) -> str:
    """An error over its noise, followed by 'its noise': '270 times'; None where it is not known."""
    return "an unknown multiple of" if error is None else f"{number(error, 3)} times"


def value_and_interval(one: dict[str, Any], unknown: str) -> tuple[str, str]:
    """The found value of a parameter and its 95 % interval, `unknown` where the moves do not determine it."""
    if not one["determined"]:
        return number(one["value"], 4), unknown
    return resolved(one["value"], one["std"]), interval(one["value"], one["std"])


def another_minute(result: dict[str, Any]) -> str:
    """What another minute of moves would gain."""
    narrower = 100.0 * result["next_minute"]
    return f"Another minute, best with {result['next_move']}, would narrow the intervals by {narrower:.0f} %."
