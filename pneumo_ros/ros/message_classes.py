"""Message types by name: their Python classes, and their definitions, read from the classes.

Definition files are not installed with all classes, and a recording must carry the definition of its bytes.
"""

import re
from importlib import import_module
from typing import Any

from pneumo_ros.errors import UsageError

_BASES = {"double": "float64", "float": "float32", "boolean": "bool", "octet": "byte"}
_SEPARATOR = "=" * 80


def message_class(message_type: str) -> Any:
    """Class of a type such as "std_msgs/msg/Float64". Raises UsageError when its package is not installed."""
    package, _, name = message_type.rpartition("/")
    try:
        return getattr(import_module(package.replace("/", ".")), name)
    except (ImportError, AttributeError, ValueError) as error:
        raise UsageError(f"{message_type} is not installed: {error}") from error


def definition(message_type: str) -> str:
    """Definition of a type as in a .msg file, followed by those of the types within it."""
    parts = {message_type: ""}
    waiting = [message_type]
    while waiting:
        current = waiting.pop()
        fields = message_class(current).get_fields_and_field_types()
        lines = [f"{_field_type(kind)} {name}" for name, kind in fields.items()]
        parts[current] = "\n".join([*lines, ""])
        for inner in map(_message_type, fields.values()):
            if inner and inner not in parts:
                parts[inner] = ""
                waiting.append(inner)
    head = parts.pop(message_type)
    return head + "".join(f"{_SEPARATOR}\nMSG: {_short(name)}\n{text}" for name, text in parts.items())


def _field_type(kind: str) -> str:
    """ "sequence<double, 3>" -> "float64[<=3]": from IDL to .msg notation."""
    if found := re.fullmatch(r"sequence<(.+?)(?:, (\d+))?>", kind):
        return f"{_field_type(found[1])}[{'<=' + found[2] if found[2] else ''}]"
    if found := re.fullmatch(r"(.+)\[(\d+)\]", kind):
        return f"{_field_type(found[1])}[{found[2]}]"
    return re.sub(r"^(w?string)<(\d+)>$", r"\1<=\2", _BASES.get(kind, kind))


def _message_type(kind: str) -> str:
    """Full name of the message type within a field's type; "" for numbers and text."""
    found = re.search(r"(\w+)/(\w+)", kind)
    return f"{found[1]}/msg/{found[2]}" if found else ""


def _short(message_type: str) -> str:
    return message_type.replace("/msg/", "/")
