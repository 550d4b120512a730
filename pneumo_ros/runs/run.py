"""A recording laid on a uniform time grid, as the integrator and the estimators need it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model
from pneumo_ros.plant.signals import DRIVE
from pneumo_ros.records import Recording
from pneumo_ros.records.unfit import check_use
from pneumo_ros.runs.noise import noise_level
from pneumo_ros.runs.smooth import Smoothed, smoothed

Array = NDArray[np.float64]

PARTS = 10  # the input is held over tenths of a sample, so that a command between two samples acts at its time
_GAP = 2.5  # samples: a grid point farther than this from any measurement is not measured
# the best sensors of such machines
_FINEST = {"position_m": 1e-8, "pressure_a_pa": 1.0, "pressure_b_pa": 1.0, "force_n": 1e-3}
SENSORS = {  # topic of each input that is measured
    "p_a": "chamber_a/pressure",
    "p_b": "chamber_b/pressure",
    "measured_supply": "supply/pressure",
    "imposed_velocity": "imposed motion",
    "load_force": "load_cell",
}
_MILLIMETRES = 20.0  # half strokes: beyond, positions are in mm or wrong


@dataclass(frozen=True)
class Run:
    """One recording on a grid of n points, `sample_time` apart. Arrays are (n,), SI units, unless said otherwise."""

    name: str
    sample_time: float  # [s]
    position: Array
    pressure_a: Array | None
    pressure_b: Array | None
    input: Array  # ((n - 1) * PARTS,) valve voltage [V], or driving force [N], held over tenths of a sample
    measured: NDArray[np.bool_]  # false inside gaps
    force_driven: bool
    further: Mapping[str, Array] = field(default_factory=dict)  # as `input`, what else is held [Pa, m/s, N]
    imposed: bool = False  # whether a test machine imposed the motion: a force is predicted, or else the pressures
    begin: float = 0.0  # [s] running time at the first point: later than 0 in a stretch of a recording

    def __len__(self) -> int:
        return len(self.position)

    @cached_property
    def time(self) -> Array:
        """Grid times [s]: running time since the recording began."""
        return np.asarray(self.begin + np.arange(len(self)) * self.sample_time, dtype=np.float64)

    @cached_property
    def held(self) -> Array:
        """(n - 1,) input over each interval, the mean of its parts."""
        return np.asarray(self.input.reshape(-1, PARTS).mean(axis=1))

    def inputs(self, names: tuple[str, ...]) -> Array:
        """The inputs of a model ((n - 1) * PARTS, names), held over tenths of a sample; U is `input`.

        Raises DataError for an input that the recording lacks.
        """
        if names == (DRIVE,):
            return self.input.reshape(-1, 1)
        if names not in self._stacked:
            self._stacked[names] = np.stack([self._held_input(name) for name in names], axis=1)
        return self._stacked[names]

    def sampled(self, names: tuple[str, ...]) -> Array:
        """The inputs of a model (n, names) from each sample on, the mean until the next; the last one is repeated.

        Raises DataError for an input that the recording lacks.
        """
        means = self.inputs(names).reshape(-1, PARTS, len(names)).mean(axis=1)
        return np.concatenate([means, means[-1:]])

    def _held_input(self, name: str) -> Array:
        if name != DRIVE and name not in self.further:
            raise DataError(
                f"{self.name} has no {SENSORS.get(name, name)}, which the model reads as {name}; record it, or leave "
                "out the effects that read it"
            )
        return self.input if name == DRIVE else self.further[name]

    @cached_property
    def _stacked(self) -> dict[tuple[str, ...], Array]:
        return {}

    @cached_property
    def force(self) -> Array:
        """(n - 1,) driving force [N] at the samples of a force-driven run; it is linear in between."""
        first, second = self.input[::PARTS], self.input[1::PARTS]
        return np.asarray(1.5 * first - 0.5 * second)

    @property
    def signals(self) -> dict[str, Array]:
        """The measured signals by their name in reports: position_m, pressure_a_pa and pressure_b_pa."""
        every = {"position_m": self.position, "pressure_a_pa": self.pressure_a, "pressure_b_pa": self.pressure_b}
        return {name: signal for name, signal in every.items() if signal is not None}

    @property
    def judged(self) -> dict[str, Array]:
        """The signals (n,) that a model predicts: `signals`, or force_n and no position where motion was imposed."""
        if not self.imposed:
            return self.signals
        if self.force_driven:
            return {"force_n": np.append(self.force, self.force[-1])}
        return {name: signal for name, signal in self.signals.items() if name != "position_m"}

    @cached_property
    def noise(self) -> dict[str, float]:
        """Noise level of every measured signal, by its report name; at least 10 nm, 1 Pa and 1 mN, for simulations."""
        every = self.signals | self.judged
        return {name: max(noise_level(signal), _FINEST[name]) for name, signal in every.items()}

    @cached_property
    def smoothed(self) -> Smoothed:
        """Smoothed measured states, with velocity and acceleration."""
        return smoothed(self.sample_time, self.position, self.pressure_a, self.pressure_b)


def make_run(
    recording: Recording,
    force_driven: bool | None = None,
    imposed: bool = False,
    areas: tuple[float, float] | None = None,
) -> Run:
    """Lay a recording on a uniform grid of its median sample time; jitter and gaps are bridged linearly.

    `force_driven` None takes the recording's own kind; `imposed`: the velocity is an input, as for a model whose
    motion a test machine imposes. Where the recording says that its motion is imposed, a force-driven run predicts its
    force, that of the load cell if there is one. With piston `areas` [m2] of the chambers a and b, the pressures drive
    a force-driven run that has no effort. Raises DataError when the recording is too short, sampled too slowly, or
    lacks the input or the absolute pressures of this kind.
    """
    time = recording.time
    driven = recording.force_driven if force_driven is None else force_driven
    if driven and areas and recording.pressures_drive:
        thrust = areas[0] * _array(recording.pressure_a) - areas[1] * _array(recording.pressure_b)
        recording = replace(recording, effort=thrust)
    check_use(recording, driven, imposed)
    counts = np.maximum(np.rint(np.diff(time) / recording.sample_time), 1.0)  # jitter must not change the rate
    intervals = int(counts.sum())
    step = float((time[-1] - time[0]) / intervals)
    grid = time[0] + step * np.arange(intervals + 1)
    nearest = np.minimum(np.searchsorted(time, grid), len(time) - 1)
    distance = np.minimum(np.abs(time[nearest] - grid), np.abs(time[np.maximum(nearest - 1, 0)] - grid))

    def lay(signal: Array | None) -> Array | None:
        return None if signal is None else np.interp(grid, time, signal)

    position = lay(recording.position)
    assert position is not None
    cells = np.repeat(grid[:-1], PARTS) + step / PARTS * (np.tile(np.arange(PARTS), intervals) + 0.5)
    if driven:
        held = np.interp(cells, time, _force(recording))
    else:
        held = np.zeros(len(cells)) if imposed and recording.command is None else _commands_at(recording, cells)
    measured = {"p_a": recording.pressure_a, "p_b": recording.pressure_b} if driven else {}
    load = None if driven and recording.imposed else recording.load_cell  # there it is the force that is predicted
    measured |= {"measured_supply": recording.supply_pressure, "load_force": load}
    further = {name: np.interp(cells, time, signal) for name, signal in measured.items() if signal is not None}
    if imposed:
        further["imposed_velocity"] = np.repeat(np.diff(position) / step, PARTS)
    return Run(
        recording.name, step, position, lay(recording.pressure_a), lay(recording.pressure_b), held,
        distance < _GAP * step, driven, further, imposed or (driven and recording.imposed),
    )  # fmt: skip


def _force(recording: Recording) -> Array:
    """The driving force [N]: where the motion is imposed, that of the load cell."""
    cell = recording.load_cell if recording.imposed else None
    return _array(recording.effort if cell is None else cell)


def _array(signal: Array | None) -> Array:
    assert signal is not None
    return signal


def check_position(model: Model, run: Run) -> None:
    """Raises DataError when a run leaves the stroke of `model` by more than an end stop yields."""
    reach = 0.5 * model["piston.stroke"]
    farthest = int(np.argmax(np.abs(run.position)))
    most = abs(run.position[farthest])
    if most > 1.05 * reach:
        unit = "; if it is in mm, type --read-as mm" if _MILLIMETRES * reach < most < 1050.0 * reach else ""
        raise DataError(
            f"{run.name}: the position is {run.position[farthest]:.4g} m at {run.time[farthest]:.3f} s, outside the "
            f"stroke of {model.name}, {-reach:g} to {reach:g} m{unit}; positions are in m from mid stroke, and the "
            "machine file sets piston.stroke"
        )


def _commands_at(recording: Recording, times: Array) -> Array:
    """The command in force at each time: the last one recorded before it, the first one before that."""
    when, value = _array(recording.command_time), _array(recording.command)
    return value[np.maximum(np.searchsorted(when, times, side="right") - 1, 0)]
