"""An identification in words, from its JSON: what terminal and report share."""

import math
from typing import Any

from pneumo_ros.compare.wording import number
from pneumo_ros.units import shown
from pneumo_ros.wording.naming import sentence
from pneumo_ros.wording.table import Table


def found_table(result: dict[str, Any]) -> Table:
    """A row for each parameter that the recordings determine: before, found, how sure."""
    rows = []
    for name, one in result["parameters"].items():
        if one["determined"]:
            rows.append((name, number(one["before"], 4), *estimate_words(one), one["unit"]))
    return Table("", ("what was found", "before", "value", "95 % interval", "unit"), tuple(rows), (1, 2))


def before_and_after(found: dict[str, Any]) -> str:
    """How far the measured friction is off the static map of the machine file before, and off the one found."""
    before, after = found["residual_before_rms_n"], found["residual_rms_n"]
    return (
        f"Friction in steady motion was {number(before)} {shown('N')} rms off the machine file, and "
        f"is {number(after)} {shown('N')} now."
    )


def estimate_words(one: dict[str, Any]) -> tuple[str, str]:
    """Value and interval, to two figures of the interval's half width, at least three of the value."""
    half = max(0.5 * (one["high"] - one["low"]), 1e-12 * abs(one["value"]))
    size = max(abs(one["value"]), half)
    digits = min(max(math.floor(math.log10(size)) - math.floor(math.log10(half)) + 2, 3), 9)
    return number(one["value"], digits), f"{number(one['low'], digits)} to {number(one['high'], digits)}"


def sentences(result: dict[str, Any]) -> list[str]:
    """What is not determined, what is known only together, and whether the static map fits."""
    said = [
        f"Not determined: {name}, which keeps {_amount(result['parameters'][name])}: {why}."
        for name, why in result["undetermined"].items()
    ]
    for name, one in result["parameters"].items():
        if not one["determined"] and name not in result["undetermined"]:
            said.append(f"{name}: {one['source']}.")
    for pair in result["correlations"]:
        if pair["strong"]:
            first, second = pair["between"]
            together = "together" if pair["r"] > 0.0 else "against each other"
            said.append(
                f"{first} and {second} are hard to distinguish (correlation {pair['r']:+.2f}): "
                f"each is known within its interval, and their errors go {together}."
            )
    return said if result["motion"] else [*said, map_sentence(result["map"])]


def _amount(one: dict[str, Any]) -> str:
    """Value and unit."""
    return number(one["value"], 5) + (f" {one['unit']}" if one["unit"] != "1" else "")


def map_sentence(found: dict[str, Any]) -> str:
    """Whether noise explains the residuals of the static map."""
    share, ratio = number(100.0 * found["share_of_force"], 2), number(found["ratio_to_noise"], 2)
    size = f"{number(found['residual_rms_n'])} {shown('N')} rms, {share} % of the force and {ratio} x the noise"
    if found["explained_by_noise"]:
        return f"The static map fits: residuals are {size}."
    if found["fits"]:
        return (
            f"The static map fits roughly: residuals are {size}. The cause is friction that does not repeat, or an "
            "effect that the machine file lacks; the intervals cover only the first; see: pneumo compare"
        )
    return (
        f"The static map does NOT fit: residuals are {size}. These parameters cannot describe the friction of "
        "this machine, and the intervals do not cover that; see: pneumo compare"
    )


def next_sentence(result: dict[str, Any]) -> str:
    """What to do with this result."""
    lacking = (
        "record what the sentences above ask for, and identify again; meanwhile " if result["undetermined"] else ""
    )
    return sentence(f"{lacking}look how the identified machine predicts, best on recordings that took no part.")
