"""A live twin: the machine file predicts, second by second, what the rig beside it does with the measured voltage.

Each window starts from a state that is estimated from the measurements around its beginning, as `pneumo compare` does;
the windows that are complete stay beside the measurements.
"""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import amount
from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import Model
from pneumo_ros.records import Recording
from pneumo_ros.runs.run import make_run
from pneumo_ros.shooting.start import AFTER, BEFORE

Array = NDArray[np.float64]
Curves = Mapping[str, tuple[list[float], list[float]]]
WINDOW = 1.0  # s of a prediction
STEP = 0.01  # s between samples: the watcher sends 100 values a second
_MARGIN = 0.1  # s more than the estimate of a start needs, as messages arrive late
_NEEDED = ("position", "pressure_a", "pressure_b", "voltage")
_SIGNALS = {"position_m": "position", "pressure_a_pa": "pressure_a", "pressure_b_pa": "pressure_b"}


@dataclass(frozen=True)
class Predicted:
    """One window: times (n,) [s] on the clock of the curves, and by signal predictions and errors (n,), SI units."""

    time: Array
    values: Mapping[str, Array]
    errors: Mapping[str, Array]


def predicted(model: Model, curves: Curves, begin: float) -> Predicted:
    """What `model` predicts from `begin` [s] for one window.

    `curves` reach from 0.4 s before to 0.2 s after it. Raises DataError and NumericalError as a comparison does.
    """
    from pneumo_ros.workbench.response import respond, stretch

    first = begin - BEFORE - _MARGIN
    grid = np.arange(first, begin + WINDOW + AFTER + _MARGIN, STEP)
    run = make_run(_recording(curves, grid), model.force_driven, model.imposed)
    part = stretch(model, run, begin - first, begin - first + WINDOW)
    found = {_SIGNALS[name]: values for name, values in respond(model, part).items() if name in _SIGNALS}
    time = first + part.time
    errors = {name: values - np.interp(time, *curves[name]) for name, values in found.items()}
    return Predicted(time, found, errors)


def _recording(curves: Curves, grid: Array) -> Recording:
    """The curves as a recording over a grid; the voltage holds until the next command."""
    time, volts = (np.array(column, dtype=float) for column in curves["voltage"])
    position, a, b = (np.interp(grid, *curves[name]) for name in _NEEDED[:3])
    held = volts[np.clip(np.searchsorted(time, grid, side="right") - 1, 0, len(volts) - 1)]
    since = grid - grid[0]
    return Recording("live", Path("live"), "", "piston", 0, since, position, None, None, a, b, None, held,
                     time - grid[0], volts, None, ())  # fmt: skip


class Twin:
    """Predicts window after window beside a live axis, each in a thread, so that no request waits; `keep` windows."""

    def __init__(self, keep: int) -> None:
        self.windows: deque[Predicted] = deque(maxlen=keep)
        self.problem = ""
        self._next: float | None = None
        self._busy = threading.Lock()

    def look(self, curves: Curves, model: Callable[[], Model]) -> threading.Thread | None:
        """Start predicting the next window if its measurements are there; None where there is nothing to do."""
        if lacking := [name for name in _NEEDED if name not in curves]:
            self.problem = f"it needs {' and '.join(lacking)}"
            return None
        begun = max(curves[name][0][0] for name in _NEEDED)
        # the voltage is held: it counts as known up to the last measurement
        last = min(curves[name][0][-1] for name in _NEEDED[:3])
        if self._next is None or self._next < begun + BEFORE + _MARGIN:
            self._next = begun + BEFORE + _MARGIN
        if last < self._next + WINDOW + AFTER + _MARGIN or not self._busy.acquire(blocking=False):
            return None
        newest = last - WINDOW - AFTER - _MARGIN
        begin = self._next + WINDOW * int((newest - self._next) // WINDOW)  # a slow machine skips windows
        self._next = begin + WINDOW
        thread = threading.Thread(target=self._predict, args=(curves, model, begin), daemon=True)
        thread.start()
        return thread

    def _predict(self, curves: Curves, model: Callable[[], Model], begin: float) -> None:
        try:
            self.windows.append(predicted(model(), curves, begin))
            self.problem = ""
        except PneumoError as problem:
            self.problem = str(problem)
        finally:
            self._busy.release()

    def curve(self, name: str) -> tuple[list[float], list[float]] | None:
        """Times and predictions of a signal in all windows, with a gap between them; None before the first one."""
        found = [one for one in list(self.windows) if name in one.values]
        times = [np.append(one.time, one.time[-1]) for one in found]
        values = [np.append(one.values[name], np.nan) for one in found]
        return (np.concatenate(times).tolist(), np.concatenate(values).tolist()) if found else None

    def says(self) -> str:
        """How near the last prediction was, in a sentence."""
        if not self.windows:
            return f"No prediction yet: {self.problem}." if self.problem else "The model predicts in a second."
        last = self.windows[-1].errors
        named = {key: name for key, name in _SIGNALS.items() if name in last}
        sizes = [f"{name.replace('_', ' ')} {amount(float(np.sqrt(np.mean(last[name] ** 2))), key)}"
                 for key, name in named.items()]  # fmt: skip
        return f"Over the last second the model was off by: {', '.join(sizes)} rms."
