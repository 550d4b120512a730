"""The input of a simulation: `constant:V`, `step:V@T`, `sine:V,HZ`, a CSV file, or a recording to replay."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.errors import DataError, UsageError, brief
from pneumo_ros.nearest import unknown_name

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_FAR = 1e12  # s; beyond it, a double does not resolve milliseconds
FORMS = "constant:V, step:V@T, sine:V,HZ, file.csv, or the folder or .mcap of a recording"


@dataclass(frozen=True)
class Drive:
    """The valve voltage as a function of time.

    voltage: times (n,) in s from the start -> voltages (n,) in V, each held until the next.
    duration: how long it lasts [s], None without an end.
    text: what it is, for a person.
    """

    voltage: "Callable[[Array], Array]"
    duration: float | None
    text: str


def parse_drive(text: str) -> Drive:
    """The drive that a SPEC names, other than a recording; UsageError says which forms there are."""
    kind, colon, rest = text.partition(":")
    if colon and kind in _FORMULAS:
        return _FORMULAS[kind](rest)
    if Path(text).suffix.lower() == ".csv":
        return read_csv(Path(text))
    if colon and "/" not in text:
        raise UsageError(f"{unknown_name('input', kind, _FORMULAS)} --input takes {FORMS}")
    raise UsageError(f"--input {text}: no such file or form; it takes {FORMS}")


def _constant(text: str) -> Drive:
    (volts,) = _numbers(text, "", "constant:V", "constant:1.1")
    return Drive(lambda time: volts * (time >= 0.0).astype(float), None, f"{volts:g} V")


def _step(text: str) -> Drive:
    volts, start = _numbers(text, "@", "step:V@T", "step:2.5@1")
    return Drive(lambda time: volts * (time >= start).astype(float), None, f"0 V, from {start:g} s on {volts:g} V")


def _sine(text: str) -> Drive:
    volts, hertz = _numbers(text, ",", "sine:V,HZ", "sine:3,0.5")
    if hertz <= 0.0:
        raise UsageError(f"sine:{text}: the frequency must be above 0 Hz; an example is sine:3,0.5")

    def voltage(time: "Array") -> "Array":
        import numpy as np

        wave: Array = volts * np.sin(2.0 * math.pi * hertz * time)
        return wave

    return Drive(voltage, None, f"{volts:g} V sine of {hertz:g} Hz")


_FORMULAS: dict[str, Callable[[str], Drive]] = {"constant": _constant, "step": _step, "sine": _sine}


def _numbers(text: str, separator: str, form: str, example: str) -> list[float]:
    parts = text.split(separator) if separator else [text]
    try:
        numbers = [float(part) for part in parts]
    except ValueError:
        numbers = []
    if len(numbers) != (2 if separator else 1) or not all(map(math.isfinite, numbers)):
        raise UsageError(
            f"{brief(text)} does not fit {form}, with finite numbers in V, s and Hz; an example is {example}"
        )
    return numbers


def read_csv(path: Path) -> Drive:
    """Two columns, time [s] and voltage [V]; a first line of names is allowed. Voltages are held until the next row.

    Raises DataError, naming the line, for anything else and for times that do not increase.
    """
    import numpy as np

    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no UTF-8 text"
        raise DataError(f"cannot read {path}: {reason}") from error
    rows: list[tuple[float, float]] = []
    for number, line in enumerate(lines, start=1):
        row = _row(line)
        if row is not None and (not rows or row[0] > rows[-1][0]):
            rows.append(row)
        elif line.strip() and not line.startswith("#") and not (number == 1 and row is None):
            expected = "a time above the last one and a voltage" if rows else "a time [s] and a voltage [V]"
            raise DataError(
                f"{path}, line {number}: expected {expected}, separated by a comma, and found {brief(line)}"
            )
    if len(rows) < 2:
        raise DataError(f"{path} holds {len(rows)} rows; needed are at least two of time [s], voltage [V]")
    time, volts = np.array(rows).T

    time -= time[0]

    def voltage(at: "Array") -> "Array":
        tolerance = 1e-9  # s, for the rounding of k dt, the start of sample k
        held: Array = volts[np.searchsorted(time, at + tolerance, side="right") - 1]
        return held

    # The last row is held as long as the one before it.
    return Drive(voltage, float(2.0 * time[-1] - time[-2]), f"{path.name}, {len(rows)} rows")


def _row(line: str) -> tuple[float, float] | None:
    try:
        time, volts = (float(cell) for cell in line.replace(";", ",").split(",")[:2])
    except ValueError:
        return None
    return (time, volts) if abs(time) < _FAR and math.isfinite(volts) else None
