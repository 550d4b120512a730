"""Units of machines that move along a line and of those that turn, and in which of them texts are written.

The equations of an effect hold for both: position y [rad], drive [N m], inertia [kg m2] and the volumes that areas
sweep per radian [m3/rad] obey the laws of y [m], drive [N], mass [kg] and areas [m2]. One table turns every unit; there
is no radius in it.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

KEY = "coordinate"  # of machine files and results
LINE, TURN = "translation", "rotation"
COORDINATES = (LINE, TURN)

# unit along a line -> unit where the machine turns, and the powers of force and length in it; others stay as they are
ROTARY = {
    "m": ("rad", 0, 1), "m/s": ("rad/s", 0, 1), "m/s2": ("rad/s2", 0, 1), "N": ("N m", 1, 0),
    "N/m": ("N m/rad", 1, -1), "N s/m": ("N m s/rad", 1, -1), "N s2/m2": ("N m s2/rad2", 1, -2),
    "N/Pa": ("N m/Pa", 1, 0), "N/V": ("N m/V", 1, 0), "1/N": ("1/(N m)", -1, 0), "kg": ("kg m2", 1, -1),
    "m2": ("m3/rad", 1, 0), "1/m": ("1/rad", 0, -1), "1/m2": ("1/rad2", 0, -2), "s/m": ("s/rad", 0, -1),
    "V s/m": ("V s/rad", 0, -1), "mm": ("mrad", 0, 1), "mm/s": ("mrad/s", 0, 1), "um/s": ("urad/s", 0, 1),
}  # fmt: skip


def unit_along(unit: str, coordinate: str) -> str:
    """What stands for `unit` in a machine of that coordinate: rad for m where it turns; other units stay."""
    return ROTARY[unit][0] if coordinate == TURN and unit in ROTARY else unit


_written: ContextVar[str] = ContextVar("coordinate in whose units texts are written", default=LINE)


def shown(unit: str) -> str:
    """The unit in the texts that are written here and now for one of a machine that moves along a line."""
    return unit_along(unit, _written.get())


def write_in(coordinate: str) -> None:
    """Write texts in the units of this coordinate from now on, as a command does that is about one machine."""
    _written.set(coordinate)


@contextmanager
def writing(coordinate: str | Mapping[str, object]) -> Iterator[None]:
    """Write texts in the units of this coordinate, or of a verb's JSON, while the block runs."""
    named = coordinate if isinstance(coordinate, str) else coordinate.get(KEY, LINE)
    token = _written.set(str(named))
    try:
        yield
    finally:
        _written.reset(token)
