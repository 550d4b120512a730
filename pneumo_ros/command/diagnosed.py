"""What `pneumo diagnose` found, as text: what is missing, on what evidence, what was refused, and what remains."""

from collections.abc import Mapping, Sequence
from typing import Any

from pneumo_ros.command.console import columns
from pneumo_ros.compare.wording import (
    EQUATIONS,
    SIGNALS,
    VARIABLES,
    amount,
    machine_changed,
    number,
    percent,
    put_off,
    times,
)

SHOWN = 4  # refused candidates
REASONS = 2  # of each
FOLLOWS = 0.1  # share of a residual that a variable must explain to be named
ENOUGH = 1.3  # noise floors: what predictions from estimated starts leave when nothing is wrong


def text(result: Mapping[str, Any]) -> str:
    """The whole answer; `result` is the verb's JSON."""
    parts = (
        headline(result), put_off(result["input_delay_s"]), failing(result), added(result["added"]), waterfall(result),
        refused(result), remaining(result), moved(result["refit"]), result["suggested_experiment"],
    )  # fmt: skip
    return "\n\n".join(part for part in parts if part)


def headline(result: Mapping[str, Any]) -> str:
    """The verdict, in a sentence or two."""
    if not result["interrupted"]:
        return _verdict(result)
    rounds = result["rounds"]
    done = f"after {rounds} round{'s' if rounds > 1 else ''} of the search" if rounds else "before any effect was tried"
    found = _verdict(result) if result["added"] else f"No effect had been added to '{result['model']}'."
    return f"INTERRUPTED {done}; what follows is what was there by then. {found}"


def _verdict(result: Mapping[str, Any]) -> str:
    model, error, left = result["model"], result["course"][-1]["holdout_error"], result["unexplained"]
    if result["verdict"] == "adequate":
        return (
            f"'{model}' is adequate: with its parameters refitted, these recordings show nothing missing; "
            f"the held-out error is {times(error)} the noise floor."
        )
    names = listed([_with_rivals(one) for one in result["added"]]) if result["added"] else ""
    if result["verdict"] == "unknown_effect":
        besides = f"{names}, and besides " if names else ""
        reasons = [f"{_equation(left['equation'])} leaves {_left(result)}"] if left and left["material"] else []
        why = "; ".join([*reasons, *([result["because"]] if result.get("because") else [])])
        why = f": {why}" if why else ""
        return f"'{model}' lacks {besides}something that no effect at hand explains{why}."
    before = result["added"][0]["holdout_error_before"]
    way = "falls" if error < before else "goes"
    with_it = "with it" if len(result["added"]) == 1 else "with them"
    return (
        f"'{model}' lacks {names}: {with_it}, the held-out error {way} from {times(before)} to {times(error)} "
        "the noise floor."
    )


def _with_rivals(one: Mapping[str, Any]) -> str:
    rivals = one["indistinguishable_from"]
    return str(one["effect"]) + (f" (or {listed(rivals, 'or')}, which explains as much)" if rivals else "")


def listed(names: Sequence[str], last: str = "and") -> str:
    """'a', 'a and b', 'a, b and c'."""
    return str(names[0]) if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}"


def _equation(name: str) -> str:
    return EQUATIONS[name][0]


def failing(result: Mapping[str, Any]) -> str:
    """Which equations the refitted model fails in, before anything is added."""
    rows = []
    for name, judged in result["equations"]["before"].items():
        if judged["explained_by_noise"] is None:
            said = "not judged: nothing slides"
        elif name in result["failing"]:
            said = "FAILS"
        else:
            said = "explained by noise" if judged["explained_by_noise"] else "little more than noise"
        rows.append((f"  {_equation(name)}", amount(judged["residual_rms"], name),
                     f"{times(judged['ratio_to_noise'])} noise", said))  # fmt: skip
    others = [name for name in result["failing"] if name not in result["equations"]["before"]]
    by_effect = f"\n  What was added puts it down to: {listed(others)}." if others else ""
    title = f"'{result['model']}' with its parameters refitted, on {_count(result['held_out'])} held out:"
    return title + "\n" + columns(rows, right=(1, 2)) + by_effect


def _count(names: Sequence[str]) -> str:
    return f"{len(names)} recording{'s' if len(names) != 1 else ''}"


def added(effects: Sequence[Mapping[str, Any]]) -> str:
    """A row for each parameter of what was added."""
    if not effects:
        return ""
    rows = [("Added", "t", "held-out error", "parameter", "value", "95 % interval", "unit")]
    for one in effects:
        error = f"{number(one['holdout_error_before'])} -> {number(one['holdout_error_after'])}"
        begin = (f"  {one['effect']}", number(one["t"]) if "t" in one else "-", error)
        for key, value in one["parameters"].items() or [("(no parameter)", None)]:
            rows.append((*begin, key, *_value(value)))
            begin = ("", "", "")
    return columns(rows, right=(1, 2, 4))


def _value(one: Mapping[str, Any] | None) -> tuple[str, str, str]:
    if one is None:
        return "", "", ""
    return number(one["value"], 4), interval(one), "" if one["unit"] == "1" else one["unit"]


def interval(one: Mapping[str, Any]) -> str:
    """'117 to 123', or that the recordings do not tell."""
    if one["std"] is None:
        return "not determined"
    digits = 4
    while digits < 8 and number(one["low"], digits) == number(one["high"], digits):
        digits += 1
    return f"{number(one['low'], digits)} to {number(one['high'], digits)}"


def waterfall(result: Mapping[str, Any]) -> str:
    """The held-out error step by step, and by signal."""
    rows = [(f"Held-out error over {result['horizon_s']:g} s", "noise floors")]
    for step in result["course"]:
        what = step["model"] if step["model"].strip(" +") else "friction refitted at breakaways"
        rows.append((f"  {what}", number(step["holdout_error"])))
    heads = {"before": "refitted", "after": "final", "noise": "noise"}
    return columns(rows, right=(1,)) + "\n\n" + by_signal(result["holdout"], heads)


def by_signal(errors: Mapping[str, Mapping[str, float]], heads: Mapping[str, str]) -> str:
    """A row for each signal, a column for each key of `errors` that has a head."""
    rows: list[Sequence[str]] = [("Error by signal", *heads.values())]
    for name in errors["noise"]:
        rows.append((f"  {SIGNALS[name][0]}", *(amount(errors[key][name], name) for key in heads)))
    return columns(rows, right=range(1, len(heads) + 1))


def refused(result: Mapping[str, Any]) -> str:
    """Rivals, and the best of the others with the reasons against them."""
    lines = []
    for one in result["candidates"]:
        if one["rival_of"]:
            lines.append((f"  {one['effect']}", number(one["t"]), f"cannot be told from {listed(one['rival_of'])}"))
    others = [one for one in result["candidates"] if not one["added"] and not one["rival_of"]]
    for one in others[:SHOWN]:
        why = "; ".join(one["objections"][:REASONS])
        lines.append((f"  {one['effect']}", number(one["t"]), why))
    return columns([("Not added", "t", "because"), *lines], right=(1,)) if lines else ""


def remaining(result: Mapping[str, Any]) -> str:
    """What the final model leaves unexplained, in which equation and against what."""
    error = result["course"][-1]["holdout_error"]
    if result["unexplained"] is None:
        yet = (
            f"\nPredictions over {result['horizon_s']:g} s are still {times(error)} the noise off, all the same: they "
            "hang on when the piston breaks away; see: pneumo compare"
        )
        return "Nothing of size remains unexplained in any equation." + (yet if error > ENOUGH else "")
    small = "" if result["unexplained"]["material"] else "; too little to be worth another effect"
    said = f"Unexplained: {_equation(result['unexplained']['equation'])} leaves {_left(result)}{small}."
    return said + _between(result["unexplained"]["moved"])


def _between(moved: Mapping[str, Any] | None) -> str:
    """That the machine itself changed between the recordings, where most of what remains is that."""
    if moved is None:
        return ""
    values = {name: (one["before"], one["after"], one["unit"]) for name, one in moved["parameters"].items()}
    return "\n" + machine_changed(moved["share"], values)


def _left(result: Mapping[str, Any]) -> str:
    left = result["unexplained"]
    ratio = result["equations"]["after"][left["equation"]]["ratio_to_noise"]
    size = f"{amount(left['residual_rms'], left['equation'])} rms, {times(ratio)} the noise"
    share = left["explained_share"]
    if not left["shape"] or share is None or share < FOLLOWS:
        most = f"more than {percent(share)} of it" if left["shape"] and share else "any of it"
        return f"{size}; none of position, velocity, voltage, pressures and time explains {most}"
    words, unit, factor = VARIABLES[left["against"]]
    (x0, y0), (x1, y1) = (pick(left["shape"], key=lambda point: point[1]) for pick in (min, max))
    return (
        f"{size}; {percent(share)} of it follows {words}, from {amount(y0, left['equation'])} at "
        f"{number(factor * x0)} {unit} to {amount(y1, left['equation'])} at {number(factor * x1)} {unit}"
    )


def moved(refit: Mapping[str, Any]) -> str:
    """Parameters that went farther than what was known of them allows."""
    if not refit["moved"]:
        return "No parameter of the model itself moved beyond what was known of it (2 standard deviations)."
    rows = [("Moved beyond what was known (2 sd)", "before", "after", "95 % interval", "unit")]
    for name in refit["moved"]:
        one = refit["parameters"][name]
        rows.append((f"  {name}", number(one["before"], 5), number(one["value"], 5), interval(one), one["unit"]))
    return columns(rows, right=(1, 2))
