"""The name and the unit in the heading of a column: `Pos(in)`, `p1 [bar]`, `t/ms`, `pressure_bar`."""

import re

from pneumo_ros.tables.units import find_unit

# name (unit), name [unit], name {unit}, name <unit>, name / unit
_BRACKETS = re.compile(
    r"^(?P<name>.*?)\s*(?:\((?P<a>[^()]*)\)|\[(?P<b>[^\[\]]*)\]|\{(?P<c>[^{}]*)\}|<(?P<d>[^<>]*)>)\s*$"
)
_SLASH = re.compile(r"^(?P<name>[^/]*[^/\s])\s*/\s*(?P<unit>[^/\s].*)$")
_TAIL = re.compile(r"^(?P<name>.*[^_\s])[_\s](?P<unit>[A-Za-zµ%°]+)$")
_LETTERS = ("A", "a")  # after an underscore they mean chamber a, as in p_A, and not amperes


def heading(text: str) -> tuple[str, str | None]:
    """Name and unit in `text`; the unit is None where there is none that is known, and the name then all of `text`."""
    for pattern in (_BRACKETS, _SLASH, _TAIL):
        found = pattern.match(text.strip())
        if found is None:
            continue
        parts = found.groupdict()
        unit = next((given for key, given in parts.items() if key != "name" and given is not None), "").strip()
        if parts["name"] and find_unit(unit) is not None and not (pattern is _TAIL and unit in _LETTERS):
            return parts["name"].strip(), unit
    return text.strip(), None


def stem(text: str) -> str:
    """The name in the heading `text`, without its unit."""
    return heading(text)[0]
