"""The report of `pneumo fleet`: machines in a table, and those in which something changed over time."""

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import number
from pneumo_ros.report.chart import Chart, Panel, Report, Section, Trace
from pneumo_ros.report.markup import Content, Html, table, tag
from pneumo_ros.report.origin import origin_section

Array = NDArray[np.float64]
SHOWN = 40  # machines with charts; the JSON holds all
PANELS = 8  # parameters of a machine with charts


def fleet_report(result: dict[str, Any], origin: dict[str, Any]) -> Report:
    """The whole page of a fleet; `result` is the verb's JSON."""
    machines = result["machines"]
    changed = [one for one in machines if one["drifted"] or one["effects"]]
    failed = sum(bool(campaign["problem"]) for one in machines for campaign in one["campaigns"])
    verdict = f"{len(changed)} of {len(machines)} machines drifted or show an effect that their model lacks."
    if failed:
        verdict += f" {failed} campaigns could not be examined."
    more = tag("p", f"{len(changed) - SHOWN} more machines changed; the JSON has them.") if len(changed) > SHOWN else ""
    charts = tuple(_machine_section(number, one) for number, one in enumerate(changed[:SHOWN]))
    sections = (_overview(machines), *charts, *([Section("more", "More", Html(more))] if more else ()))
    title = f"Fleet of {len(machines)} machines"
    return Report(title, verdict, not changed and not failed, (*sections, origin_section(origin)), result)


def _overview(machines: Sequence[Mapping[str, Any]]) -> Section:
    rows: list[tuple[Content, ...]] = []
    for one in machines:
        dates = [campaign["date"][:10] for campaign in one["campaigns"]]
        drifted = ", ".join(f"{name} since {moved['date'][:10]}" for name, moved in one["drifted"].items())
        found = ", ".join(f"{name} since {effect['date'][:10]}" for name, effect in one["effects"].items())
        rows.append((one["machine"], str(len(dates)), dates[0], dates[-1], drifted or "-", found or "-"))
    head = ("machine", "campaigns", "first", "last", "drifted", "effects found")
    return Section("machines", "Machines", table(head, rows, "Machines", numeric=(1,)))


def _machine_section(place: int, one: Mapping[str, Any]) -> Section:
    """A machine's parameters over time: first those that drifted, then those of found effects, then the others."""
    tracks, first = one["parameters"], one["campaigns"][0]["date"]
    names = sorted(tracks, key=lambda name: (name not in one["drifted"], name.partition(".")[0] not in one["effects"]))
    panels = tuple(_panel(name, tracks[name], first) for name in names[:PANELS])
    said = "; ".join(
        f"{name}: {number(m['first'])} to {number(m['last'])} {m['unit']}" for name, m in one["drifted"].items()
    )
    words = f"Values with their 95 % intervals. Drifted: {said or 'nothing'}."
    key = f"machine-{place}"
    if not panels:
        return Section(key, one["machine"], tag("p", "No campaign determined a parameter."))
    title = f"Parameters of {one['machine']}"
    chart = Chart(key, title, words, f"days since {first[:10]}", panels, height=130 * len(panels) + 120, legend=False)
    return Section(key, one["machine"], tag("p", words, class_="soft"), charts=(chart,))


def _panel(name: str, points: Sequence[Mapping[str, Any]], first: str) -> Panel:
    days = np.array([_days(first, point["date"]) for point in points])
    value, low, high = (np.array([point[key] for point in points], dtype=float) for key in ("value", "low", "high"))
    traces = (
        Trace("95 %", "quiet", "band", days, low, high),
        Trace(name, "model", "line", days, value),
        Trace(name, "measured", "dots", days, value),
    )
    unit = "" if points[0]["unit"] == "1" else f" [{points[0]['unit']}]"
    return Panel(f"{name.partition('.')[2]}{unit}", traces)


def _days(first: str, date: str) -> float:
    begin, end = (datetime.strptime(text, "%Y-%m-%dT%H:%M:%SZ") for text in (first, date))
    return (end - begin).total_seconds() / 86400.0
