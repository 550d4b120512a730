"""What the names of columns say: words that speak for a signal or against it."""

import re

from pneumo_ros.tables.heading import heading
from pneumo_ros.tables.signals import SIGNALS
from pneumo_ros.tables.units import find_unit

NEEDED = 2  # points from which a column is taken for a signal
UNIT = 3  # points for a unit of the signal's dimension
_NAMED = ("reference", "command", "supply_pressure")  # and signals without words of their own: only by their names
_REFERENCE = r"\b(ref|reference|goal|target|set ?point|desired|wanted|demand|soll)\b"
_FRICTION = r"\b(friction|reibung|reibkraft)\b"  # that a motion takes: it drives nothing
CURRENT = r"\b(curr|current|strom|amps?|i)\b"  # of a motor, whose torque it makes
_GAS = r"\b(p|pa|pb|ps|pressure|press|prs|druck)\b"
# signal -> (pattern of the words in a name, points)
_WORDS: dict[str, tuple[tuple[str, int], ...]] = {
    "position": (
        (r"\b(pos|position|stroke|displacement|encoder|lvdt|angle|theta|weg|hub)\b", 4),
        (r"^(x|y|z|q|qm|s|phi)( \d)?$", 3),
        (_REFERENCE, -6), (r"\b(valve|spool|error)\b", -6),
    ),
    "velocity": (
        (r"\b(vel|velocity|speed|spd|geschwindigkeit|xdot|omega)\b", 4), (r"^(v|w|dx|dy|dq|qd)$", 3), (_REFERENCE, -6),
    ),
    "force": (
        (r"\b(motor|drive|driving|actuator|applied|input) (force|torque)\b", 6),
        (r"\b(torque|effort|tau|drehmoment|vir)\b", 4), (r"\b(force|kraft|load|pwm)\b", 3), (r"^f$", 3),
        (r"\b(cell|test machine|measured)\b", -4), (_FRICTION, -6), (_REFERENCE, -6),
    ),
    "load_cell": (
        (r"\b(load ?cell|(rod|test machine|machine|measured) force|force (sensor|cell|meas|measured))\b", 6),
        (r"\b(force|kraft)\b", 2), (_FRICTION, 4), (_REFERENCE, -6),
    ),
    "pressure_a": (
        (_GAS, 1), (r"\b(a|1|cap|bore|piston|lower|pa)\b", 2), (r"\b(spring|chamber|cyl|cylinder|gas)\b", 1),
        (r"\b(hyd|hydraulic|oil|amb|ambient|atm|tank)\b|^pb", -3), (_REFERENCE, -6),
    ),
    "pressure_b": (
        (_GAS, 1), (r"\b(b|2|rod|upper|annulus|pb)\b", 2), (r"\b(spring|chamber|cyl|cylinder|gas)\b", 1),
        (r"\b(hyd|hydraulic|oil|amb|ambient|atm|tank)\b|^pa", -3), (_REFERENCE, -6),
    ),
    "supply_pressure": (
        (_GAS, 1), (r"\b(supply|source|line|main|versorgung|ps)\b|^p s$|^p 0$", 4),
        (r"\b(hyd|hydraulic|oil|amb|ambient|atm|tank)\b", -3), (r"^p$|\b(a|b|1|2|upper|lower)\b", -2),
    ),
    "command": (
        (r"\b(valve|command|cmd|control|ventil|spool)\b", 4),
        (r"^(u|uv|ctrl|input)( \d)?$", 3), (r"\b(voltage|volt)\b", 1),
        (r"\b(supply|bus|batt|battery|vin|load|curr|current|bias)\b|^input volt", -7),
    ),
    "reference": (
        (_REFERENCE, 4), (r"\b(pos|position|stroke|angle)\b", 1),
        (r"\b(curr|current|force|torque|pressure|speed|vel)\b", -7),
    ),
}  # fmt: skip


def words_of(name: str) -> str:
    """The words in the name of a column, in small letters: `LowerSpringPressure` is `lower spring pressure`."""
    return " ".join(re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[^\W\d_]+|\d+", name)).lower()


def points(signal: str, column: str) -> int:
    """How much name and unit of a column speak for a signal; at most 0 where its unit speaks against it."""
    name, unit = heading(column)
    found = find_unit(unit) if unit else None
    if found is not None and found.dimension not in SIGNALS[signal].dimensions:
        return 0
    texts = {words_of(name), words_of(column)}
    gas = (found is not None and found.dimension == "pressure") or any(re.search(_GAS, text) for text in texts)
    if SIGNALS[signal].dimensions == ("pressure",) and not gas:  # a letter or number alone says nothing
        return 0
    score = UNIT if found is not None and signal in _WORDS and signal not in _NAMED else 0
    for pattern, worth in _WORDS.get(signal) or ((rf"\b{signal.replace('_', ' ')}\b", 6),):
        if any(re.search(pattern, text) for text in texts):
            score += worth
    return score
