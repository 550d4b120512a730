"""HTML that is escaped unless it was made here: names in recordings are untrusted."""

import json
from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

from pneumo_ros.wording.table import Table

_VOID = ("meta", "br", "hr", "col", "input")


class Html(str):
    """Text that is markup already; every other text is escaped when it enters a page."""

    __slots__ = ()


Content = Html | str | Iterable["Content"]


def html(content: Content) -> Html:
    """Markup of the content: markup stays, text is escaped, sequences are joined."""
    if isinstance(content, Html):
        return content
    if isinstance(content, str):
        return Html(_escaped(content))
    return Html("".join(html(part) for part in content))


def _escaped(text: str) -> str:
    """Escaped; bytes of a file name that are no UTF-8 become question marks, as they cannot be written."""
    return escape(text.encode("utf-8", "replace").decode("utf-8"), quote=True)


def tag(element: str, /, *content: Content, **attributes: str | bool | None) -> Html:
    """An element. Attributes: `class_` is class, `aria_label` is aria-label, True stands alone, None is left out."""
    words = [element]
    for key, value in attributes.items():
        if value is None or value is False:
            continue
        label = key.rstrip("_").replace("_", "-")
        words.append(label if value is True else f'{label}="{_escaped(str(value))}"')
    opened = f"<{' '.join(words)}>"
    return Html(opened if element in _VOID else f"{opened}{html(content)}</{element}>")


def table(
    head: Sequence[Content], rows: Iterable[Sequence[Content]], caption: Content, *, numeric: Sequence[int] = ()
) -> Html:
    """A table whose first column names the rows; `numeric` columns align to the right. It scrolls within the page."""

    def cell(k: int, content: Content) -> Html:
        kind = "number" if k in numeric else None
        return tag("th", content, scope="row") if k == 0 else tag("td", content, class_=kind)

    top = tag(
        "tr", [tag("th", name, scope="col", class_="number" if k in numeric else None) for k, name in enumerate(head)]
    )
    body = [tag("tr", [cell(k, content) for k, content in enumerate(row)]) for row in rows]
    inner = tag("table", tag("caption", caption), tag("thead", top), tag("tbody", body))
    return scrolling(inner, "Table: " + _plain(caption))


def worded(found: Table, caption: str = "") -> Html:
    """A table of the wording; `caption` replaces a missing title."""
    return table(found.head, found.rows, found.title or caption, numeric=found.numeric)


def scrolling(content: Content, label: str) -> Html:
    """Content that may be wider than the page; reachable and scrollable by keyboard."""
    return tag("div", content, class_="wide", role="region", aria_label=label, tabindex="0")


def _plain(content: Content) -> str:
    return content if isinstance(content, str) and not isinstance(content, Html) else "wide content"


def data_block(identifier: str, data: Any) -> Html:
    """JSON in a script element that no browser runs; nothing in it can end the element."""
    text = json.dumps(data, allow_nan=False, separators=(",", ":"))
    safe = text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
    return Html(f'<script type="application/json" id="{_escaped(identifier)}">{safe}</script>')
