"""What a user can be told: one class per exit code of the commands, and the wording for misspelt names."""

from collections.abc import Iterable
from difflib import get_close_matches


class PneumoError(Exception):
    """Any failure that is explained to the user in words; `exit_code` is what a command then returns."""

    exit_code = 1


class UsageError(PneumoError):
    """A wrong name, option, value or combination of them."""

    exit_code = 2


class DataError(PneumoError):
    """A recording or file that cannot be read, or does not hold what is needed."""

    exit_code = 3


class NumericalError(PneumoError):
    """A computation that did not converge or left the finite numbers."""

    exit_code = 4


def unknown_name(kind: str, given: str, allowed: Iterable[str]) -> str:
    """Sentence for an unknown name: what was given, the nearest allowed names, or all of them when none is near."""
    names = sorted(allowed)
    # Names are dotted or snake case: compare without regard to case, answer in the spelling that is allowed.
    spelling = {name.lower(): name for name in names}
    near = [spelling[name] for name in get_close_matches(given.lower(), spelling, n=3, cutoff=0.6)]
    if near:
        return f"Unknown {kind} '{given}'. Did you mean {' or '.join(repr(name) for name in near)}?"
    if not names:
        return f"Unknown {kind} '{given}'. There is none to choose from."
    return f"Unknown {kind} '{given}'. Allowed: {', '.join(names)}."
