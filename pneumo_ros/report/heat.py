"""The heat map: a table, so that it works with keyboard and screen reader, and without scripts."""

from pneumo_ros.compare.wording import times
from pneumo_ros.report.chart import HeatMap
from pneumo_ros.report.markup import Html, scrolling, tag

STEPS = (1.3, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)  # times the noise: where the next colour begins


def heat(ratio: float | None) -> str:
    """Class of a ratio's colour: heat-0 where noise explains it, up to heat-7; heat-none without a ratio."""
    if ratio is None or ratio != ratio:
        return "heat-none"
    return f"heat-{sum(ratio > step for step in STEPS)}"


def heat_table(heat_map: HeatMap) -> Html:
    """Rows of linked cells, with the ratio large and its value small, and the scale below.

    All cells of a row lead to the same run; heard alone, each link says which run, and of what it is the error.
    """
    head = tag("tr", tag("td"), [tag("th", name, scope="col") for name in heat_map.columns])
    rows = []
    for name, href, ratios, texts in zip(heat_map.rows, heat_map.hrefs, heat_map.ratios, heat_map.texts, strict=True):
        cells = [
            tag("td", _cell(ratio, text, href, f"{name}, {column}"), class_=heat(ratio))
            for ratio, text, column in zip(ratios, texts, heat_map.columns, strict=True)
        ]
        rows.append(
            tag("tr", tag("th", tag("a", name, href=href, aria_label=f"{name}: its plots"), scope="row"), cells)
        )
    inner = tag("table", tag("caption", heat_map.title), tag("thead", head), tag("tbody", rows), class_="heat")
    return Html(scrolling(inner, heat_map.title) + scale())


def _cell(ratio: float | None, text: str, href: str, of: str) -> Html:
    """The link of a cell."""
    return tag(
        "a", tag("b", times(ratio)), " ", tag("small", text), href=href, aria_label=f"{times(ratio)} {text}: {of}"
    )


def scale() -> Html:
    """What the colours mean."""
    names = [f"up to {STEPS[0]:g} x noise", *(f"up to {step:g} x" for step in STEPS[1:]), "more"]
    keys = [tag("li", name, class_=f"heat-{k}") for k, name in enumerate(names)]
    return tag("ul", keys, class_="scale", aria_label="Scale of the colours")
