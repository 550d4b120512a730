"""Units as exponents of the SI's base units."""

import re
from collections import Counter

_DERIVED = {
    "kg": {"kg": 1}, "m": {"m": 1}, "s": {"s": 1}, "A": {"A": 1}, "K": {"K": 1}, "rad": {"rad": 1}, "1": {},
    "Hz": {"s": -1}, "N": {"kg": 1, "m": 1, "s": -2}, "Pa": {"kg": 1, "m": -1, "s": -2},
    "J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}, "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
}  # fmt: skip
_TOKEN = re.compile(r"\s*([A-Za-z]+\d*|1|[()/*])")


def exponents(unit: str) -> dict[str, int] | None:
    """Whole exponents of the base units, {"m": 1, "s": -1} for m/s; None where there are none, as for sqrt(Pa)."""
    tokens = _TOKEN.findall(unit)
    if "".join(tokens) != unit.replace(" ", ""):
        return None
    try:
        found, rest = _product(tokens)
    except (KeyError, IndexError):
        return None
    return {base: n for base, n in found.items() if n} if not rest else None


def _product(tokens: list[str]) -> tuple[Counter[str], list[str]]:
    """The product of `tokens` up to a closing bracket, and what follows; a / divides by the next factor only."""
    found: Counter[str] = Counter()
    sign = 1
    while tokens and tokens[0] != ")":
        token, tokens = tokens[0], tokens[1:]
        if token in "/*":
            sign = -1 if token == "/" else 1
            continue
        if token == "(":
            factor, tokens = _product(tokens)
            tokens = tokens[1:]
        else:
            factor = _factor(token)
        for base, n in factor.items():
            found[base] += sign * n
        sign = 1
    return found, tokens


def _factor(token: str) -> Counter[str]:
    name = token.rstrip("0123456789") or token
    power = int(token[len(name) :] or 1)
    return Counter({base: n * power for base, n in _DERIVED[name].items()})
