"""The message for an unknown name."""

from collections.abc import Iterable
from difflib import get_close_matches


def unknown_name(kind: str, given: str, allowed: Iterable[str]) -> str:
    """Sentence for an unknown name: what was given, the nearest allowed names, or all of them when none is near."""
    names = sorted(set(allowed))
    spelling = {name.lower(): name for name in names}
    near = [spelling[name] for name in get_close_matches(given.lower(), spelling, n=3, cutoff=0.6)]
    if near:
        return f"unknown {kind} '{given}'; did you mean {' or '.join(near)}?"
    return f"unknown {kind} '{given}'; " + (f"known are {', '.join(names)}" if names else "none is known")
