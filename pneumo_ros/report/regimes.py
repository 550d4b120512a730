"""Regimes against signals and equations: how large the error is in each, and how much of it."""

from collections.abc import Mapping
from typing import Any

from pneumo_ros.compare.wording import REGIMES, TARGETS, percent, times
from pneumo_ros.report.chart import Section
from pneumo_ros.report.heat import heat
from pneumo_ros.report.markup import Html, scrolling, tag

_SHORTEST = 0.05  # s in a regime; shorter ones are not judged


def regimes_section(result: dict[str, Any]) -> Section:
    """All runs together."""
    total = sum(run["duration_s"] for run in result["runs"])
    times_in = {
        name: sum(run["regimes"].get(name, 0.0) * run["duration_s"] for run in result["runs"]) / total
        for name in result["regimes"]
    }
    notes = (
        "A sample may be in several regimes, so only the shares of stick and slide add up to 100 %. The momentum is "
        "judged while the piston slides: at rest friction takes any value up to its limit."
    )
    meanings = [tag("li", tag("b", REGIMES[n]), f": {text}") for n, text in result["regimes"].items()]
    body = (
        tag("p", notes, class_="soft"),
        regime_table({**result["signals"], **result["equations"]}, times_in, "all runs"),
        tag("details", tag("summary", "What the regimes are"), tag("ul", meanings)),
    )
    return Section("regimes", "Regimes", Html("".join(body)))


def regime_table(found: Mapping[str, Any], shares: Mapping[str, float], whose: str) -> Html:
    """Regimes x signals and equations: `found` holds their regimes, `shares` the share of the time in each regime."""
    columns = [tag("th", TARGETS[name][0], scope="col") for name in found]
    head = tag("tr", tag("th", "regime", scope="col"), tag("th", "time", scope="col", class_="number"), columns)
    rows = [_row(name, share, found) for name, share in shares.items()]
    caption = tag("caption", f"Error over noise in each regime, and the regime's share of the squared error: {whose}")
    return scrolling(
        tag("table", caption, tag("thead", head), tag("tbody", rows), class_="heat"), f"Regimes of {whose}"
    )


def _row(name: str, share: float, found: Mapping[str, Any]) -> Html:
    cells = [_cell(one["regimes"].get(name), share > 0.0) for one in found.values()]
    return tag("tr", tag("th", REGIMES[name], scope="row"), tag("td", percent(share), class_="number"), cells)


def _cell(share: Mapping[str, Any] | None, occurs: bool) -> Html:
    if share is None or share["seconds"] < _SHORTEST:
        return tag("td", tag("small", "not judged" if occurs else "-"), class_="heat-none")
    part = f"{percent(share['share'])} of the error"
    text = (tag("b", times(share["ratio_to_noise"])), " ", tag("small", part))
    return tag("td", text, class_=heat(share["ratio_to_noise"]))
