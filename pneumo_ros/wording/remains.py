"""The unexplained residual of a diagnosis: its equation, the variable it follows, and changes of the machine."""

from collections.abc import Mapping
from typing import Any

from pneumo_ros.compare.wording import VARIABLES, amount, number, percent, times
from pneumo_ros.diagnose.verdict import SIGNIFICANT
from pneumo_ros.wording.naming import equation_words, sentence, the

FOLLOWS = 0.1  # share of a squared residual that a variable must explain to be named
NEW_EFFECT = (
    "A new effect has to reproduce this shape: it is a few lines of Python, and takes part in the search with "
    "--effects FILE.py."
)


def remains(result: Mapping[str, Any]) -> tuple[str, ...]:
    """Sentences on what the final model leaves; `result` is the JSON of `diagnose`."""
    left = result["unexplained"]
    if left is None:
        return _nothing(result)
    small = "" if left["material"] else ", which is too little to be worth another effect"
    words = [f"{sentence(leaves(result))}{small}.", follows(left)]
    if left["moved"]:
        words.append(machine_changed(left["moved"]))
    return (*words, *([NEW_EFFECT] if left["material"] and left["shape"] else []))


def machine_changed(moved: Mapping[str, Any]) -> str:
    """The share that other values of the model's own parameters explain; `moved` is part of `unexplained`."""
    moves = [
        f"{name} {number(one['before'], 4)} -> {number(one['after'], 4)} {one['unit']}".rstrip()
        for name, one in moved["parameters"].items()
    ]
    return (
        f"{percent(moved['share'])} of it disappears when the model's own parameters are fitted to the held-out "
        f"recordings: {', '.join(moves)}. The machine itself has changed between the recordings, for example by "
        "temperature or wear."
    )


def leaves(result: Mapping[str, Any]) -> str:
    """The equation and its unexplained residual, as the end of a sentence."""
    left = result["unexplained"]
    ratio = result["equations"]["after"][left["equation"]]["ratio_to_noise"]
    size = f"{amount(left['residual_rms'], left['equation'])} rms"
    return f"{the(left['equation'])} leaves {size} unexplained, {times(ratio)} the noise"


def follows(left: Mapping[str, Any]) -> str:
    """The variable that the residual follows, and its share; `left` is `unexplained` in the JSON."""
    share, shape = left["explained_share"], left["shape"]
    if not left["against"]:
        return "These recordings hold too little of it to show which variable it follows."
    if not shape or share is None or share < FOLLOWS:
        most = f"more than {percent(share)} of it" if shape and share else "any of it"
        return f"None of position, velocity, voltage, pressures and time explains {most}."
    words, unit, factor = VARIABLES[left["against"]]
    ends = (pick(shape, key=lambda point: point[1]) for pick in (min, max))
    (x0, low), (x1, high) = ((f"{number(factor * x)} {unit}", amount(y, left["equation"])) for x, y in ends)
    return f"{percent(share)} of it follows {words}, from {low} at {x0} to {high} at {x1}."


def _nothing(result: Mapping[str, Any]) -> tuple[str, ...]:
    error = result["course"][-1]["holdout_error"]
    ratios = [
        f"{equation_words(name)} {times(judged['ratio_to_noise'])}"
        for name, judged in result["equations"]["after"].items()
        if judged["explained_by_noise"] is not None
    ]
    over = f" Residual over noise: {', '.join(ratios)}." if ratios else ""
    yet = (
        f"The errors of predictions over {result['horizon_s']:g} s are still {times(error)} the noise: they depend on "
        "the moment at which the piston breaks away; see: pneumo compare"
    )
    return f"Nothing significant remains unexplained in any equation.{over}", *([yet] if error > SIGNIFICANT else [])
