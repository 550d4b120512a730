"""A recording laid on a uniform time grid, as the integrator and the estimators need it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.measured import MEASURED
from pneumo_ros.plant import Model
from pneumo_ros.plant.actuator import SIDES, Chamber
from pneumo_ros.plant.signals import DRIVE
from pneumo_ros.records import Recording
from pneumo_ros.records.unfit import check_use
from pneumo_ros.runs.noise import noise_level
from pneumo_ros.runs.rests import resting
from pneumo_ros.runs.smooth import Smoothed, smoothed
from pneumo_ros.units import LINE, TURN

Array = NDArray[np.float64]

PARTS = 10  # the input is held over tenths of a sample, so that a command between two samples acts at its time
_GAP = 2.5  # samples: a grid point farther than this from any measurement is not measured
# the best sensors of such machines
_FINEST = {"position_m": 1e-8, "pressure_a_pa": 1.0, "pressure_b_pa": 1.0, "force_n": 1e-3, "flow_a_kg_s": 1e-9}
SENSORS = {  # topic of each input beside U
    "U_b": "valve_b/command",
    "p_a": "chamber_a/pressure",
    "p_b": "chamber_b/pressure",
    "imposed_velocity": "imposed motion",
    **{one.input: one.topic for one in MEASURED},
}
POSITION, METERED = "position_m", "metered_flow_a"
_SMALL = {LINE: ("mm", 1e3), TURN: ("deg", 180.0 / np.pi)}  # in which positions come, too
_LEAST = 0.02  # of half the stroke: a unit in which the piston moves less is not named
ATMOSPHERE = 101325.0  # Pa, for machine files without it


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
    by_pressures: bool = False  # whether the input is the force of the measured pressures on the piston
    computed: frozenset[str] = frozenset()  # names in `further` that no sensor measured: a model gives them
    assumed: frozenset[str] = frozenset()  # report names of pressures that no sensor measured: they are not judged

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
        if names not in self._sampled:
            means = self.averaged(names, 1)
            self._sampled[names] = np.concatenate([means, means[-1:]])
        return self._sampled[names]

    def averaged(self, names: tuple[str, ...], parts: int) -> Array:
        """The inputs of a model ((n - 1) * parts, names), their means over `parts` of each sample, a divisor of PARTS.

        Raises DataError for an input that the recording lacks.
        """
        if (names, parts) not in self._averaged:
            held = self.inputs(names)
            self._averaged[names, parts] = held.reshape(-1, PARTS // parts, len(names)).mean(axis=1)
        return self._averaged[names, parts]

    def _held_input(self, name: str) -> Array:
        if name != DRIVE and name not in self.further:
            raise DataError(
                f"{self.name} has no {SENSORS.get(name, name)}, which the model reads as {name}; record it, or leave "
                "out the effects that read it"
            )
        return self.input if name == DRIVE else self.further[name]

    # kept, as a diagnosis asks for the inputs of a run thousands of times
    @cached_property
    def _stacked(self) -> dict[tuple[str, ...], Array]:
        return {}

    @cached_property
    def _averaged(self) -> dict[tuple[tuple[str, ...], int], Array]:
        return {}

    @cached_property
    def _sampled(self) -> dict[tuple[str, ...], Array]:
        return {}

    @cached_property
    def force(self) -> Array:
        """(n - 1,) driving force [N] at the samples of a force-driven run; it is linear in between."""
        return _at_samples(self.input)

    @property
    def signals(self) -> dict[str, Array]:
        """The measured signals by their name in reports: position_m, pressure_a_pa and pressure_b_pa."""
        every = {"position_m": self.position, "pressure_a_pa": self.pressure_a, "pressure_b_pa": self.pressure_b}
        return {name: signal for name, signal in every.items() if signal is not None}

    def pressure_of(self, chamber: str) -> Array | None:
        """The measured pressure (n,) [Pa] of chamber `a` or `b`; None where no sensor measured it."""
        pressure = self.pressure_a if chamber == "a" else self.pressure_b
        return None if f"pressure_{chamber}_pa" in self.assumed else pressure

    @property
    def judged(self) -> dict[str, Array]:
        """The signals (n,) that a model predicts: the measured ones, without position where the motion is an input.

        Where it was imposed on a force-driven machine, force_n. The flow that a flow meter reads, flow_a_kg_s.
        """
        if self.imposed and self.force_driven:
            return {"force_n": np.append(self.force, self.force[-1])}
        driving = {"position_m"} if self.imposed else set()
        found = {name: signal for name, signal in self.signals.items() if name not in driving | self.assumed}
        if METERED in self.further and not self.force_driven:
            held = self.further[METERED]
            found["flow_a_kg_s"] = np.append(_at_samples(held), 1.5 * held[-1] - 0.5 * held[-2])
        return found

    @cached_property
    def noise(self) -> dict[str, float]:
        """Noise level of every measured signal, by its report name; at least `_FINEST`, as a simulation has none."""
        every = self.signals | self.judged
        return {name: max(noise_level(signal), _FINEST[name]) for name, signal in every.items()}

    @cached_property
    def smoothed(self) -> Smoothed:
        """Smoothed measured states, with velocity and acceleration."""
        further = {name: signal for name, signal in self.signals.items() if name != POSITION}
        return smoothed(self.sample_time, self.position, further)

    @cached_property
    def rests(self) -> NDArray[np.bool_]:
        """Samples (n,) at which the piston rests."""
        return resting(self.smoothed.motion[:, 0], self.noise[POSITION], self.sample_time)

    def sensed(self, chambers: Sequence[Chamber]) -> list[Chamber]:
        """Those chambers whose pressure a sensor measured: the others are not judged."""
        return [chamber for chamber in chambers if chamber.signal not in self.assumed]

    def pressures(self, chambers: Sequence[Chamber]) -> Array:
        """(n, chambers) the measured pressures of a machine's chambers [Pa]."""
        columns = [self.signals[chamber.signal] for chamber in chambers]
        return np.stack(columns, axis=1) if columns else np.empty((len(self), 0))


def make_run(
    recording: Recording,
    force_driven: bool | None = None,
    imposed: bool = False,
    areas: tuple[float, float] | None = None,
    atmosphere: float = ATMOSPHERE,
    chambers: Sequence[Chamber] | None = None,
    commanded: bool = True,
    self_driven: bool = False,
) -> Run:
    """Lay a recording on a uniform grid of its median sample time; jitter and gaps are bridged linearly.

    `force_driven` None takes the recording's own kind; `imposed`: the velocity is an input, as for a model whose
    motion a test machine imposes. Where the recording says that its motion is imposed, a force-driven run predicts its
    force, that of the load cell if there is one. With piston `areas` [m2] of the chambers a and b, the pressures drive
    a force-driven run that has no effort; a chamber without a sensor then has the pressure of the `atmosphere` [Pa]. In
    chambers whose motion is an input, a pressure without a sensor is constant and not judged. `chambers` are those of
    the machine, by default of a double-acting cylinder; the pressure of another side is left out. Without a valve, a
    run need not be `commanded`; a `self_driven` machine needs no force, and its input is 0. Raises DataError when the
    recording is too short, sampled too slowly, or lacks the input or the absolute pressures of this kind.
    """
    time = recording.time
    driven = recording.force_driven if force_driven is None else force_driven
    by_pressures = bool(driven and areas and recording.pressures_drive and not self_driven)
    if self_driven:
        recording = replace(recording, effort=np.zeros(len(time)))
    if areas and by_pressures:
        both = [atmosphere if p is None else p for p in (recording.pressure_a, recording.pressure_b)]
        recording = replace(recording, effort=np.asarray(areas[0] * both[0] - areas[1] * both[1]))
    fields = [f"pressure_{side}" for side in SIDES] if chambers is None else [chamber.field for chamber in chambers]
    if not driven:
        none: dict[str, Any] = {f"pressure_{s}": None for s in SIDES if f"pressure_{s}" not in fields}
        recording = replace(recording, **none)
    check_use(recording, driven, imposed, fields, commanded)
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
    pressures, assumed = {"a": lay(recording.pressure_a), "b": lay(recording.pressure_b)}, set[str]()
    for chamber, other in ("ab", "ba") if imposed and not driven else ():
        if pressures[chamber] is None and f"pressure_{chamber}" in fields:
            assumed.add(f"pressure_{chamber}_pa")
            pressures[chamber] = np.full(len(grid), _array(pressures[other]).mean())
    cells = np.repeat(grid[:-1], PARTS) + step / PARTS * (np.tile(np.arange(PARTS), intervals) + 0.5)
    if driven:
        held = np.interp(cells, time, _force(recording))
    else:
        free = recording.command is None and (imposed or not commanded)
        held = np.zeros(len(cells)) if free else _commands_at(recording, cells)
    measured = {"p_a": recording.pressure_a, "p_b": recording.pressure_b} if driven else {}
    measured |= {one.input: recording.signals.get(one.name) for one in MEASURED}
    computed = frozenset[str]()
    if driven and recording.imposed:
        del measured["load_force"]  # there it is the force that is predicted
        computed = _shared(measured)
    further = {name: np.interp(cells, time, signal) for name, signal in measured.items() if signal is not None}
    if recording.command_b is not None and recording.command_b_time is not None:
        further["U_b"] = _in_force(recording.command_b_time, recording.command_b, cells)
    if imposed:
        further["imposed_velocity"] = np.repeat(np.diff(position) / step, PARTS)
    return Run(
        recording.name, step, position, pressures["a"], pressures["b"], held, distance < _GAP * step, driven, further,
        imposed or (driven and recording.imposed), by_pressures=by_pressures, computed=computed,
        assumed=frozenset(assumed),
    )  # fmt: skip


def _shared(measured: dict[str, Array | None]) -> frozenset[str]:
    """Give both sides of a friction rig the pressure of its one sensor, and name the side without one.

    Such a rig presses on its seals with the pressure that it measures, so that their mean is that pressure.
    """
    known = [one for one in (measured["p_a"], measured["p_b"]) if one is not None]
    absent = frozenset(name for name in ("p_a", "p_b") if measured[name] is None)
    if len(known) != 1:
        return frozenset()
    measured |= dict.fromkeys(absent, known[0])
    return absent


def run_for(recording: Recording, model: Model) -> Run:
    """`make_run` with what `model` needs; DataError when the recording lacks it."""
    areas = (model["piston.area_a"], model["piston.area_b"])
    atmosphere = model.parameters.get("air.atmospheric_pressure", ATMOSPHERE)
    return make_run(
        recording, model.force_driven, model.imposed, areas, atmosphere, model.chambers, model.has_valve,
        model.self_driven,
    )  # fmt: skip


def _force(recording: Recording) -> Array:
    """The driving force [N]: where the motion is imposed, that of the load cell."""
    cell = recording.load_cell if recording.imposed else None
    return _array(recording.effort if cell is None else cell)


def _at_samples(held: Array) -> Array:
    """(n - 1,) what is linear between the samples, at the samples, of its values over tenths of each."""
    return np.asarray(1.5 * held[::PARTS] - 0.5 * held[1::PARTS])


def _array(signal: Array | None) -> Array:
    assert signal is not None
    return signal


def check_position(model: Model, run: Run) -> None:
    """Raises DataError when a run leaves the stroke of `model` by more than an end stop yields."""
    reach = 0.5 * model["piston.stroke"]
    farthest = int(np.argmax(np.abs(run.position)))
    most = abs(run.position[farthest])
    if most > 1.05 * reach:
        m, (small, factor) = model.unit("m"), _SMALL[model.coordinate]
        in_small = _LEAST * factor * reach < most < 1.05 * factor * reach
        unit = f"; if it is in {small}, type --read-as {small}" if in_small else ""
        if most <= 2.05 * reach and np.ptp(run.position) <= 2.05 * reach:
            zero = factor * reach * np.sign(run.position[farthest])
            unit = f"; if it is zero at an end, type --read-as zero={zero:g}{small}; pneumo rig check finds such things"
        raise DataError(
            f"{run.name}: the position is {run.position[farthest]:.4g} {m} at {run.time[farthest]:.3f} s, outside the "
            f"stroke of {model.name}, {-reach:g} to {reach:g} {m}{unit}; positions are in {m} from mid stroke, and the "
            "machine file sets piston.stroke"
        )


def _commands_at(recording: Recording, times: Array) -> Array:
    """The command in force at each time: the last one recorded before it, the first one before that."""
    return _in_force(_array(recording.command_time), _array(recording.command), times)


def _in_force(when: Array, value: Array, times: Array) -> Array:
    return value[np.maximum(np.searchsorted(when, times, side="right") - 1, 0)]
