"""A report as one HTML file: it contains everything it needs, and may load nothing from elsewhere."""

import base64
import hashlib
from importlib.resources import files
from typing import Any

import numpy as np

from pneumo_ros.report.chart import Chart, Panel, Report, Section, Trace
from pneumo_ros.report.heat import heat_table
from pneumo_ros.report.markup import Html, data_block, tag
from pneumo_ros.report.series import encode
from pneumo_ros.report.still import still as drawing


def page_html(report: Report) -> Html:
    """The whole page as text. Scripts run only by their hash, so that no text of a recording can run as one."""
    from plotly.offline import get_plotlyjs

    scripts = [get_plotlyjs(), *(_asset(name) for name in ("series.js", "plots.js", "page.js"))]
    charts = {figure.name: chart_json(figure) for figure in report.charts() if isinstance(figure, Chart)}
    body = (
        tag("a", "Skip to the content", class_="skip", href="#content"),
        _header(report),
        tag("main", [section_html(section, stills=True) for section in report.sections], id="content", tabindex="-1"),
        data_block("result", report.result),
        data_block("charts", charts),
        *(Html(f"<script>{text}</script>") for text in scripts),
    )
    head = (
        tag("meta", charset="utf-8"),
        tag("meta", http_equiv="Content-Security-Policy", content=_policy(scripts)),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", name="color-scheme", content="light dark"),
        tag("title", report.title),
        Html(f"<style>{_asset('page.css')}</style>"),
    )
    page = tag("html", tag("head", head), tag("body", body), lang="en")
    return Html(f"<!doctype html>\n{page}\n")


def _policy(scripts: list[str]) -> str:
    """Nothing is fetched; scripts run only by their hash; plots may set styles and save pictures."""
    digests = (base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in scripts)
    hashes = " ".join(f"'sha256-{digest}'" for digest in digests)
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )


def _asset(name: str) -> str:
    return files("pneumo_ros.report").joinpath(f"assets/{name}").read_text(encoding="utf-8")


def _header(report: Report) -> Html:
    links = [tag("li", tag("a", section.title, href=f"#{section.identifier}")) for section in report.sections]
    return tag(
        "header",
        tag("p", "pneumo_ros", class_="brand"),
        tag("h1", report.title),
        _verdict(report),
        tag("nav", tag("ul", links), aria_label="Sections"),
        tag("noscript", tag("p", "Without JavaScript the plots are drawings that cannot be zoomed.", class_="warning")),
        tag("p", class_="warning", id="trouble", hidden=True, role="alert"),
    )


def _verdict(report: Report) -> Html:
    """The sentence; a badge puts its sign and word before it, in large letters."""
    badge = report.badge
    if badge is None:
        return tag("p", report.verdict, class_=f"verdict {'good' if report.good else 'bad'}")
    sign = tag("span", badge.sign, class_="sign", aria_hidden="true")
    words = tag("span", tag("strong", badge.word, class_="badge"), " ", report.verdict)
    return tag("p", sign, words, class_=f"verdict large {badge.tone}")


def section_html(section: Section, level: int = 2, *, stills: bool = False) -> Html:
    """A section with its figures and parts; a folded one opens by a click. `stills`: each chart as a drawing, too."""
    heading = tag(f"h{level}", section.title, id=f"{section.identifier}-title")
    figures = [figure_html(chart, still=stills) for chart in section.charts]
    inner: list[Html] = [section.body]
    if section.heat:
        inner.append(heat_table(section.heat))
    if figures:
        inner.append(tag("div", figures, class_="charts" if section.columns == 1 else "charts beside"))
    inner += [section_html(part, level + 1, stills=stills) for part in section.parts]
    label = f"{section.identifier}-title"
    if section.folded:
        folded = tag("details", tag("summary", heading), inner)
        return tag("section", folded, id=section.identifier, aria_labelledby=label)
    return tag("section", heading, inner, id=section.identifier, aria_labelledby=label, tabindex="-1")


def figure_html(chart: Chart, *, still: bool = False) -> Html:
    """The place of a chart, which the page's script fills once it comes into view; `still`: its drawing for paper."""
    words = f"{chart.title}. {chart.words}"
    place = tag("div", class_="plot", id=chart.name, style=f"height:{chart.height}px", role="img", aria_label=words)
    caption = tag("figcaption", tag("strong", chart.title), " ", tag("span", chart.words))
    return tag("figure", caption, place, drawing(chart) if still else "")


def chart_json(chart: Chart) -> dict[str, Any]:
    """A chart for the page's script."""
    return {
        "title": chart.title, "x": chart.x_title, "link": chart.link, "span": chart.span, "logX": chart.log_x,
        "legend": chart.legend, "panels": [_panel(panel) for panel in chart.panels],
    }  # fmt: skip


def _panel(panel: Panel) -> dict[str, Any]:
    return {
        "title": panel.title, "share": panel.share, "ticks": panel.ticks,
        "traces": [_trace(trace) for trace in panel.traces],
    }  # fmt: skip


def _trace(trace: Trace) -> dict[str, Any]:
    found: dict[str, Any] = {"name": trace.name, "role": trace.role, "kind": trace.kind, "hidden": trace.hidden}
    if trace.resolution > 0.0:
        return found | {"series": encode(trace.x, trace.y, trace.resolution)}
    found |= {"x": _numbers(trace.x), "y": _numbers(trace.y)} | ({"texts": trace.texts} if trace.texts else {})
    return found | ({"high": _numbers(trace.y_high)} if trace.y_high is not None else {})


def _numbers(values: Any) -> list[float | None]:
    """Rounded to six digits, more than a screen shows; null where not finite."""
    return [float(f"{v:.6g}") if np.isfinite(v) else None for v in values]
