"""The signals of a run by name: measured ones, velocity and force from them, and any column of its topics."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare.wording import SIGNALS
from pneumo_ros.records import Recording
from pneumo_ros.units import shown
from pneumo_ros.workbench.columns import Column

Array = NDArray[np.float64]
FIELDS = {"position_m": "position", "pressure_a_pa": "pressure_a", "pressure_b_pa": "pressure_b"}
INPUT, VELOCITY, EFFORT = "input", "velocity", "effort"
_SMOOTH = 0.02  # s over which a velocity is taken from positions


@dataclass(frozen=True)
class Rig:
    """What a force from pressures needs: both piston areas [m2] and the atmosphere's pressure [Pa]."""

    area_a: float
    area_b: float
    atmosphere: float


@dataclass(frozen=True)
class Curve:
    """A signal over time (n,), in the unit that is shown; `steps`: held until the next value."""

    title: str
    unit: str
    time: Array
    values: Array
    steps: bool = False

    @property
    def label(self) -> str:
        """Title and unit of an axis."""
        return f"{self.title} [{self.unit}]" if self.unit else self.title

    def at(self, time: Array) -> Array:
        """The values at other times."""
        return np.interp(time, self.time, self.values) if len(self.time) else np.full(len(time), np.nan)


def curve(name: str, recording: Recording, rig: Rig, columns: Mapping[str, Column]) -> Curve | None:
    """The signal of that name; None where the recording has none."""
    time = recording.time
    if name in FIELDS:
        words, unit, factor = SIGNALS[name]
        values = getattr(recording, FIELDS[name])
        return None if values is None else Curve(words, unit, time, factor * values)
    if name == INPUT:
        return _input(recording)
    if name == VELOCITY:
        return _velocity(recording)
    if name == EFFORT:
        return _effort(recording, rig)
    return Curve(name, "", *columns[name]) if name in columns else None


def _input(recording: Recording) -> Curve | None:
    driven = recording.voltage is None
    values = recording.effort if driven else recording.voltage
    words, unit = ("driving force", shown("N")) if driven else ("valve voltage", "V")
    return None if values is None else Curve(words, unit, recording.time, values, steps=True)


def _velocity(recording: Recording) -> Curve:
    """As measured, else from the positions 10 ms before and after."""
    if recording.velocity is not None:
        return Curve("velocity", shown("m/s"), recording.time, recording.velocity)
    half, time = 0.5 * _SMOOTH, recording.time
    ends = [np.interp(np.clip(time + off, time[0], time[-1]), time, recording.position) for off in (-half, half)]
    spans = np.clip(time + half, time[0], time[-1]) - np.clip(time - half, time[0], time[-1])
    return Curve("velocity from positions", shown("m/s"), time, (ends[1] - ends[0]) / np.maximum(spans, 1e-9))


def _effort(recording: Recording, rig: Rig) -> Curve | None:
    """As measured, else from both pressures: A_a p_a - A_b p_b - p_atm (A_a - A_b)."""
    a, b = recording.pressure_a, recording.pressure_b
    if recording.effort is not None:
        return Curve("force", shown("N"), recording.time, recording.effort)
    if a is None or b is None:
        return None
    force = rig.area_a * a - rig.area_b * b - rig.atmosphere * (rig.area_a - rig.area_b)
    return Curve("force from pressures", shown("N"), recording.time, force)
