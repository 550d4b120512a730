"""The errors that are reported to the user: one class for each exit code of the commands."""

import reprlib


class PneumoError(Exception):
    """A failure that is explained to the user in words; a command then returns `exit_code`."""

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


class OutOfTimeError(KeyboardInterrupt):
    """A deadline has passed: like Ctrl-C, it ends work that returns what it has by then."""


_SHORT = reprlib.Repr()
_SHORT.maxlevel = 2  # the content of a file may be long and deeply nested


def brief(value: object) -> str:
    """A given value for an error message, shortened to one line."""
    return _SHORT.repr(value)
