"""What `pneumo identify` found, as text: the table, what is not determined, and which stretches were used."""

import re
from typing import Any

from pneumo_ros.command.console import columns
from pneumo_ros.compare.wording import number
from pneumo_ros.units import shown
from pneumo_ros.wording.identification import estimate_words, sentences

_SHOWN_STRETCHES = 4  # of a run; the others are counted


def text(result: dict[str, Any], verbose: bool) -> str:
    """The whole answer; `result` is the verb's JSON."""
    parts = [
        headline(result), parameters(result), "\n".join(sentences(result)), directions(result),
        "" if result["motion"] else stretches(result), refusals(result) if verbose else "",
    ]  # fmt: skip
    return "\n\n".join(part for part in parts if part)


def headline(result: dict[str, Any]) -> str:
    """The windows that are used, and the noise of the method."""
    points, runs, motion = result["map"]["points"], result["runs"], result["motion"]
    if motion:
        return (
            f"{motion['why']}: fitted by the motion in {motion['segments']} segments of {count(len(runs), 'run')}.\n"
            f"Within them, predictions are {number(motion['misfit'], 2)} x the noise off (rms)."
        )
    windows, used = sum(run["windows"] for run in runs), len(points["velocity"])
    span = result["map"]["window_s"]
    speed, force = (sorted(points[key])[used // 2] for key in ("velocity_std", "force_std"))
    return (
        f"{used} of {windows} windows of {span:g} s in {count(len(runs), 'run')} are steady; "
        f"{count(len(result['breakaways']), 'breakaway')}.\n"
        f"Velocities are slopes of the position over {span:g} s; sensor noise gives them "
        f"an error of {number(1e6 * speed, 2)} {shown('um/s')}, and the forces one of "
        f"{number(force, 2)} {shown('N')} (medians)."
    )


def parameters(result: dict[str, Any]) -> str:
    """The table: before, value, interval, unit, where from."""
    rows = [("", "before", "value", "95 % interval", "unit", "from")]
    for name, one in result["parameters"].items():
        value, interval = estimate_words(one) if one["determined"] else (number(one["value"], 5), "-")
        source = one["source"] if one["determined"] else re.split("[:,]", one["source"])[0]
        rows.append((name, number(one["before"], 5), value, interval, one["unit"], source))
    return columns(rows, right=(1, 2))


def directions(result: dict[str, Any]) -> str:
    """Both directions side by side, and whether they differ."""
    if "directions" not in result:
        return ""
    found = result["directions"]
    sides = {name: found[name] for name in ("extending", "retracting")}
    names = list(dict.fromkeys(n for side in sides.values() for n in (*side["parameters"], *side["undetermined"])))
    rows = [("per direction", *sides, "unit", "")]
    for name in names:
        known = [side["parameters"].get(name) for side in sides.values()]
        cells = ["{} ({})".format(*estimate_words(one)) if one else "not determined" for one in known]
        unit = next((s["parameters"][name]["unit"] for s in sides.values() if name in s["parameters"]), "")
        rows.append((name, *cells, unit, "DIFFER" if name in found["differ"] else ""))
    said = [f"{name.capitalize()}: {side['problem']}." for name, side in sides.items() if "problem" in side]
    return "\n".join([columns(rows), *said, _difference(found)])


def _difference(found: dict[str, Any]) -> str:
    if not found["compared"]:
        return "The directions cannot be compared: no parameter is determined in both."
    if found["differ"]:
        return f"The directions differ beyond their intervals in: {', '.join(found['differ'])}."
    return f"The directions do not differ beyond their intervals in: {', '.join(found['compared'])}."


def stretches(result: dict[str, Any]) -> str:
    """A line for each run: steady stretches, and reasons of refusal."""
    rows = [("run", "steady", "from - to [s]", f"speed [{shown('mm/s')}]", "refused windows")]
    for run in result["runs"]:
        parts = run["stretches"]
        spans = [f"{p['start_s']:.2f} - {p['stop_s']:.2f}" for p in parts[:_SHOWN_STRETCHES]]
        more = [f"{len(parts) - _SHOWN_STRETCHES} more"] if len(parts) > _SHOWN_STRETCHES else []
        speeds = [1e3 * p["velocity"] for p in parts]
        span = (
            f"{min(speeds):.1f}" + (f" .. {max(speeds):.1f}" if max(speeds) - min(speeds) > 0.05 else "")
            if parts
            else "-"
        )
        why = ", ".join(f"{number} {reason}" for reason, number in run["refused"].items()) or "-"
        if not run["windows"]:
            why = "no constant input for as long as a window"
        rows.append((run["name"], f"{run['used']} of {run['windows']}", ", ".join(spans + more) or "-", span, why))
    return columns(rows)


def refusals(result: dict[str, Any]) -> str:
    """Every refused window."""
    rows = [("refused in run", "from - to [s]", "at", "why")]
    rows += [
        (one["run"], f"{one['start_s']:.2f} - {one['stop_s']:.2f}", f"{one['input']:+.4g}", one["detail"])
        for one in result["refused"]
    ]
    return columns(rows) if len(rows) > 1 else "No window is refused."


def count(number: int, thing: str) -> str:
    """'1 run', '3 runs'."""
    return f"{number} {thing}" + ("" if number == 1 else "s")
