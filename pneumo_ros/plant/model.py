"""A machine: effects and the values of their parameters, ready to be simulated. Models are immutable."""

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from types import MappingProxyType, ModuleType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.actuator import SIDES, Actuator, Chamber
from pneumo_ros.plant.compose import Composition, compose
from pneumo_ros.plant.coordinate import Scale, coordinate_of
from pneumo_ros.plant.effect import Effect, Parameter
from pneumo_ros.plant.held import held_inputs, input_rows
from pneumo_ros.plant.kernels import load_kernel
from pneumo_ros.plant.lacking import lacking, missing_parameters, without_chambers
from pneumo_ros.plant.lanes import acting_in, fitting, follow_lanes, follow_one, run_lanes
from pneumo_ros.plant.library import USUAL_FRAME, Library, is_part
from pneumo_ros.plant.reach import fades
from pneumo_ros.plant.uncertainty import SECTION, deviations, nested
from pneumo_ros.plant.usual import usual_size
from pneumo_ros.units import KEY, LINE, TURN, unit_along

Array = NDArray[np.float64]
STEP = 1e-4  # s, the default step
LONGER = 1e-3  # share by which a step may be longer: 1 kHz by the clock of a recording is 1 kHz


class Model:
    """Effects in order, a value for every parameter, and the kernel compiled for them.

    Build one with `load_model`, or from another by `with_parameters` and `with_effects`.
    """

    def __init__(
        self,
        composition: Composition,
        values: Mapping[str, float],
        name: str,
        library: Library,
        uncertainty: Mapping[str, float] | None = None,
    ) -> None:
        """Use `Model.build`, which validates."""
        self.composition, self.name, self.library = composition, name, library
        self.parameters: Mapping[str, float] = MappingProxyType({key: values[key] for key in composition.parameters})
        self.uncertainty: Mapping[str, float] = MappingProxyType(dict(uncertainty or {}))
        """Stated standard deviations of parameters, in their units; most machine files state none."""

    @classmethod
    def build(
        cls,
        effects: Iterable[str],
        values: Mapping[str, object],
        *,
        name: str = "model",
        library: Library | None = None,
        frame: Iterable[str] = USUAL_FRAME,
        defaults: bool = False,
        uncertainty: Mapping[str, object] | None = None,
        measured: Iterable[str] = (),
        coordinate: object = None,
    ) -> "Model":
        """A model of `effects` with `values` by dotted name, and `uncertainty`: deviations of some of them.

        A missing value is an error unless `defaults` or unless its default adds nothing. `measured` as in `measuring`;
        `coordinate`: "translation" or "rotation", by default that of `library` or of the part that actuates it.

        Raises UsageError, with the nearest names, for unknown or repeated effects and unknown, missing or bad values.
        """
        library = library or Library()
        names = tuple(effects)
        repeated = sorted({n for n in names if names.count(n) > 1})
        if repeated:
            raise UsageError(f"effect {repeated[0]} is listed twice")
        library = _along(library, coordinate, tuple(frame), values)
        parts = (*(library.part(f) for f in frame), *(library.find(n) for n in names))
        if sentence := without_chambers(parts, library):
            raise UsageError(sentence)
        try:
            composition = compose(parts, tuple(measured))
        except UsageError as problem:
            if sentence := lacking(parts, library):
                raise UsageError(sentence) from problem
            raise
        checked = _checked(composition, values, defaults)
        return cls(composition, checked, name, library, deviations(composition, checked, uncertainty or {}))

    # --- what it is -------------------------------------------------------------------------------------------------

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the effects, in order, without the frame: piston, air and what actuates the machine."""
        return tuple(e.name for e in self.composition.effects if not is_part(e))

    @property
    def exact(self) -> frozenset[str]:
        """Parameters that the machine file states to be known exactly: no fit moves them."""
        return frozenset(name for name, deviation in self.uncertainty.items() if deviation == 0.0)

    @property
    def coordinate(self) -> str:
        """Whether it moves along a line, "translation", or turns, "rotation": in rad, N m and kg m2."""
        return self.library.coordinate

    def unit(self, along_a_line: str) -> str:
        """The unit of this machine for one of a machine that moves along a line: rad for m where it turns."""
        return unit_along(along_a_line, self.coordinate)

    def require_metres(self, who: str) -> None:
        """Raise UsageError, in which `who` plans in metres, for a machine that turns."""
        if self.coordinate != LINE:
            raise UsageError(
                f"{who} plans in m and N; {self.name} turns, in rad and N m ('{KEY}: {TURN}'). Give a machine that "
                f"moves along a line; of one that turns, simulate, compare, identify, diagnose, add and export do"
            )

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states, in the order of state vectors: y, v, the chambers' pressures, then the effects' own."""
        return self.composition.states

    @property
    def imposed(self) -> bool:
        """Whether a test machine imposes the motion: the momentum equation is not judged."""
        return "imposed_motion" in self.effects

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the held inputs: U, then the measured signals that effects read and that are no states here."""
        return self.composition.inputs

    @property
    def actuator(self) -> type[Actuator] | None:
        """The part that actuates the machine; None where a measured force [N] does, which then is the input."""
        return self.composition.actuator

    @property
    def chambers(self) -> tuple[Chamber, ...]:
        """The chambers of its actuator, in the order of their pressures among the states."""
        return self.composition.chambers

    @property
    def force_driven(self) -> bool:
        """Whether the input is a measured force [N] instead of a valve voltage: a machine file without actuator."""
        return self.actuator is None

    @property
    def self_driven(self) -> bool:
        """Whether effects compute the drive of a machine without chambers, as a motor does in its loop: U is unused."""
        functions = (f for effect in self.composition.effects for f in effect.functions.values())
        return self.force_driven and any("drive" in function.writes for function in functions)

    def require_two_chambers(self, who: str) -> None:
        """Raise UsageError, in which `who` needs them, unless the piston has air on both sides."""
        if len(self.chambers) != len(SIDES):
            what = f"its part '{self.actuator.name}' has one" if self.actuator else "a measured force drives it"
            raise UsageError(
                f"{who} needs chambers on both sides of the piston; of {self.name}, {what}. Give a machine file with a "
                "section 'chambers'"
            )

    @property
    def has_valve(self) -> bool:
        """Whether a valve lets air in and out: without one, the chambers are sealed and need no command."""
        flows = {f"valve_flow_{chamber.side}" for chamber in self.chambers}
        functions = (f for effect in self.composition.effects for f in effect.functions.values())
        return any(flows.intersection(function.writes) for function in functions)

    @property
    def frame(self) -> int:
        """How many states come first and are measured: position, velocity, and the pressure of each chamber."""
        return 2 + len(self.chambers)

    def __getitem__(self, dotted: str) -> float:
        if dotted not in self.parameters:
            raise UsageError(unknown_name("parameter", dotted, self.parameters))
        return self.parameters[dotted]

    def specification(self, dotted: str) -> Parameter:
        """Unit, default, range and meaning of a parameter; UsageError with the nearest names."""
        return self.composition.parameter(dotted)

    def usual_size(self, dotted: str) -> float:
        """Usual distance of a parameter from its neutral value, above 0; UsageError with the nearest names."""
        self.specification(dotted)
        section, _, key = dotted.partition(".")
        return usual_size(self._effect(section), key)

    def idle(self, effect: str) -> set[str]:
        """Dotted names of the parameters of one of its effects that do nothing in the form that it has."""
        kind = self._effect(effect)
        return {f"{effect}.{key}" for key in kind.idle({key: self[f"{effect}.{key}"] for key in kind.parameters})}

    def _effect(self, name: str) -> type[Effect]:
        return next(effect for effect in self.composition.effects if effect.name == name)

    def cautions(self) -> tuple[str, ...]:
        """Sentences on values that are allowed but unwise, such as friction that is not passive."""
        found = (_caution(self, effect) for effect in self.composition.effects if "caution" in effect.functions)
        return tuple(sentence for sentence in found if sentence)

    def as_dict(self) -> dict[str, object]:
        """The machine file as a nested dictionary: effects, section -> parameter -> value, and stated uncertainty."""
        result: dict[str, object] = {"effects": list(self.effects)}
        result |= {} if self.coordinate == LINE else {KEY: self.coordinate}
        for dotted, value in self.parameters.items():
            section, _, key = dotted.partition(".")
            inner = result.setdefault(section, {})
            assert isinstance(inner, dict)
            inner[key] = value
        return result | ({SECTION: nested(self.uncertainty)} if self.uncertainty else {})

    # --- variants ---------------------------------------------------------------------------------------------------

    def with_parameters(self, values: Mapping[str, object], name: str | None = None) -> "Model":
        """The same effects with other values; UsageError, with the nearest names, for unknown or bad ones."""
        checked = _checked(self.composition, {**self.parameters, **values}, defaults=False)
        return Model(self.composition, checked, name or self.name, self.library, self.uncertainty)

    def with_uncertainty(self, known: Mapping[str, float]) -> "Model":
        """The same machine, with `known` as the standard deviations of its parameters, by dotted name, in their units.

        What is known exactly stays so where `known` does not name it. Raises UsageError, with the nearest names, for
        unknown parameters, and for what is no deviation.
        """
        stated = deviations(self.composition, self.parameters, {**dict.fromkeys(self.exact, 0.0), **known})
        return Model(self.composition, self.parameters, self.name, self.library, stated)

    def with_effects(self, effects: Iterable[str], values: Mapping[str, object] | None = None) -> "Model":
        """Another list of effects; shared parameters keep their values, new ones take `values` or their defaults."""
        frame = tuple(e.name for e in self.composition.effects if is_part(e))
        measured = self.composition.measured
        model = Model.build(
            effects, {}, name=self.name, library=self.library, frame=frame, defaults=True, measured=measured
        )
        kept = {key: value for key, value in self.parameters.items() if key in model.parameters}
        stated = {key: value for key, value in self.uncertainty.items() if key in model.parameters}
        larger = model.with_parameters({**kept, **(values or {})})
        return Model(larger.composition, larger.parameters, larger.name, larger.library, stated)

    def measuring(self, names: Iterable[str]) -> "Model":
        """The same machine with the named measured signals as inputs, in place of constants; () for none.

        `measured_supply` takes the place of air.supply_pressure where the valve's flow depends on it.
        """
        measured = tuple(sorted(names))
        if measured == self.composition.measured:
            return self
        return Model(
            compose(self.composition.effects, measured), self.parameters, self.name, self.library, self.uncertainty
        )

    # --- simulation -------------------------------------------------------------------------------------------------

    @cached_property
    def kernel(self) -> ModuleType:
        """The compiled module: `run`, `run_lanes`, `follow`, `follow_lanes`, `rates`, `observe` (see `emit`)."""
        return load_kernel(self.composition.text)

    @property
    def values(self) -> Array:
        """Parameter vector (parameters,) in kernel order; a fresh copy."""
        return np.array(list(self.parameters.values()))

    def state(self, **given: float) -> Array:
        """State vector (states,) with the given entries; others at rest, pressures atmospheric.

        Raises UsageError for unknown or non-finite entries, for positions beyond the stroke, and for chambers without
        volume at an end of the stroke.
        """
        for key, value in given.items():
            if key not in self.states:
                raise UsageError(unknown_name("state", key, self.states))
            if not math.isfinite(value):
                raise UsageError(f"initial {key} is {value}; it takes a finite number")
        reach = 0.5 * self["piston.stroke"]
        if abs(given.get("y", 0.0)) > 1.05 * reach:
            unit = self.unit("m")
            raise UsageError(
                f"initial y is {given['y']:g} {unit}, outside the stroke of {-reach:g} to {reach:g} {unit}"
            )
        return self._begin(given)

    def continued(self, other: "Model", state: ArrayLike) -> Array:
        """State vector (states,) that continues from a `state` (states,) of another model.

        States of the same name keep their values, new ones start as in `Model.state`. Raises UsageError for chambers
        without volume at an end of the stroke.
        """
        return self._begin(dict(zip(other.states, np.asarray(state, dtype=float).tolist(), strict=True)))

    def _begin(self, given: Mapping[str, float]) -> Array:
        self._check_volumes()
        rest: dict[str, float | str] = {
            s: effect.states[s].initial for effect in self.composition.effects for s in effect.states
        }
        rest |= {chamber.state: self["air.atmospheric_pressure"] for chamber in self.chambers}
        begin = {s: given.get(s, rest[s]) for s in rest}
        return np.array([float(begin[b] if isinstance(b, str) else b) for b in begin.values()])

    def _check_volumes(self) -> None:
        for chamber in self.chambers:
            swept = 0.5 * self["piston.stroke"] * self[chamber.area]
            if self[chamber.volume] <= swept:
                raise UsageError(
                    f"chamber {chamber.side} has no volume left at its end: {chamber.volume} (at mid stroke) is "
                    f"{self[chamber.volume]:g} m3, the piston sweeps {swept:g} m3 of it; increase it"
                )

    def simulate(
        self,
        voltage: ArrayLike,
        state: ArrayLike,
        *,
        sample_time: float = 1e-3,
        step: float = STEP,
        start: float = 0.0,
        parts: int = 1,
    ) -> Array:
        """Integrate from `state` (states,) while voltage[k] [V] is held over sample k; returns (samples, states).

        A model with several `inputs` takes (samples, inputs) instead, here and in all other methods.
        Row k is the state at the END of sample k. `sample_time` [s] is divided into equal steps no longer than `step`
        [s]; `start` [s] is the time of the first sample. With `parts` > 1 a sample holds that many voltages one after
        another. Raises NumericalError, with the time, when the state leaves the finite numbers, and UsageError for a
        step that is not positive or a voltage that does not fill whole samples.
        """
        held, x = held_inputs(voltage, self.inputs), self._state_vector(state)
        out = np.empty((_whole(len(held), parts), len(x)))
        stride, h = substeps(sample_time / parts, step)
        self.kernel.run(x, self.values, held, start, h, stride, parts, out)
        if not np.isfinite(x).all():
            bad = int(np.argmin(np.isfinite(out).all(axis=1)))
            raise NumericalError(
                f"the state of {self.name} left the finite numbers at t = {start + bad * sample_time:.3f} s; "
                f"take a shorter step than {h:g} s or less stiff parameters"
            )
        return out

    def simulate_lanes(
        self,
        voltage: ArrayLike,
        states: ArrayLike,
        parameters: ArrayLike | None = None,
        *,
        samples: int | None = None,
        first: ArrayLike | None = None,
        sample_time: float = 1e-3,
        step: float = STEP,
        start: ArrayLike = 0.0,
        parts: int = 1,
        threads: int = 1,
        columns: Sequence[int] | None = None,
    ) -> Array:
        """Integrate many lanes at once, each several times faster than `simulate`; returns (lanes, samples, states).

        voltage (n,) [V] is shared; lane i begins with voltage[first[i]] (default 0) and goes on as `simulate`.
        states (lanes, states), parameters (lanes, parameters) or None for the model's own; samples: by default as many
        as the voltage covers; `start` [s], one or (lanes,), is the time of voltage[0]; `columns`: the states to return,
        default all. Lanes that leave the finite numbers are returned without an error. Raises UsageError for shapes
        that do not fit.
        """
        x = np.array(states, dtype=float, ndmin=2)
        q = np.tile(self.values, (len(x), 1)) if parameters is None else np.array(parameters, dtype=float)
        held = held_inputs(voltage, self.inputs)
        begin = np.zeros(len(x), dtype=np.int64) if first is None else np.asarray(first, dtype=np.int64)
        if x.shape[1] != len(self.states) or q.shape != (len(x), len(self.parameters)) or begin.shape != (len(x),):
            raise UsageError(
                f"lanes do not fit: states {x.shape}, parameters {q.shape}, first {begin.shape}; "
                f"needed are (lanes, {len(self.states)}), (lanes, {len(self.parameters)}), (lanes,)"
            )
        last = int(begin.max(initial=0))
        count = _whole(len(held) - last, parts) if samples is None else samples
        if len(x) and (begin.min() < 0 or last + count * parts > len(held)):
            raise UsageError(f"lanes reach beyond the {len(held)} voltages given")
        stride, h = substeps(sample_time / parts, step)
        t0 = np.asarray(start, dtype=float) + begin * (sample_time / parts)
        return run_lanes(self.kernel, x, q, held, begin, t0, h, stride, parts, count, threads, columns)

    def follow(
        self,
        measured: ArrayLike,
        voltage: ArrayLike,
        rest: ArrayLike,
        *,
        sample_time: float = 1e-3,
        step: float = STEP,
        start: float = 0.0,
        parts: int = 1,
    ) -> tuple[Array, Array]:
        """Drive the effects' own states along a measured motion; returns states, derivatives, both (samples, states).

        measured (samples, m): the frame's states at every sample: y, v and the pressure of each chamber;
        voltage: `parts` of them are held one after another between two samples; rest: values of the other states at
        sample 0, which is at time `start` [s]. The derivatives are those of the equations, averaged over the interval
        that ends at each sample: where they differ from the measurement, the equation fails. Row 0 of the derivatives
        repeats row 1.
        """
        given, tail = np.array(measured, dtype=float, ndmin=2), np.array(rest, dtype=float, ndmin=1)
        if given.shape[1] + len(tail) != len(self.states):
            raise UsageError(f"{given.shape[1]} measured and {len(tail)} other states given; needed: {self.states}")
        held = held_inputs(voltage, self.inputs)
        if _whole(len(held), parts) < len(given) - 1:
            raise UsageError(f"{len(held)} voltages do not cover {len(given)} samples")
        stride, h = substeps(sample_time / parts, step)
        X, out = follow_one(self.kernel, given, held, tail, self.values, start, h, stride, parts)
        out[0] = out[1] if len(out) > 1 else 0.0
        return X, out

    def follow_lanes(
        self,
        measured: ArrayLike,
        voltage: ArrayLike,
        rest: ArrayLike,
        parameters: ArrayLike,
        *,
        sample_time: float = 1e-3,
        step: float = STEP,
        start: float = 0.0,
        parts: int = 1,
        threads: int = 1,
        states: Iterable[str] | None = None,
        columns: Iterable[str] | None = None,
        passing: bool = False,
    ) -> tuple[Array, Array]:
        """Follow one measured motion with many lanes of parameters, each several times faster than `follow`.

        measured (samples, m) shared by all lanes or (lanes, samples, m); voltage shared; rest (others,) or (lanes,
        others); parameters (lanes, parameters). Returns what `follow` returns for each lane, to the bit: states (lanes,
        samples, len(states)) and derivatives (lanes, samples, len(columns)) of the states named, in that order; None
        means all of them. `passing`: pass over effects at their neutral values, whose states then stay as they begin;
        it takes a fraction of the time, and what else is returned differs by rounding. Raises UsageError for shapes
        that do not fit and unknown names.
        """
        others = len(self.states) - self.frame
        given, tail, q = fitting(measured, rest, parameters, self.frame, others, len(self.parameters))
        held = held_inputs(voltage, self.inputs)
        if _whole(len(held), parts) < given.shape[1] - 1:
            raise UsageError(f"{len(held)} voltages do not cover {given.shape[1]} samples")
        stride, h = substeps(sample_time / parts, step)
        kept, wanted = self._indices(states), self._indices(columns)
        effects = self.composition.effects
        acting = acting_in(effects, q)
        acting = acting if passing else np.ones_like(acting)
        return follow_lanes(
            self.kernel, given, held, tail, q, acting, self.owners, len(effects), kept, wanted,
            start, h, stride, parts, threads,
        )  # fmt: skip

    @cached_property
    def owners(self) -> NDArray[np.int64]:
        """By state (states,), which of the effects that fade has it; -1 for those of all others."""
        owners = {
            state: k for k, effect in enumerate(filter(fades, self.composition.effects)) for state in effect.states
        }
        return np.array([owners.get(state, -1) for state in self.states], dtype=np.int64)

    def _indices(self, names: Iterable[str] | None) -> NDArray[np.int64]:
        chosen = self.states if names is None else tuple(names)
        for name in chosen:
            if name not in self.states:
                raise UsageError(unknown_name("state", name, self.states))
        return np.array([self.states.index(name) for name in chosen], dtype=np.int64)

    def outputs(
        self, states: ArrayLike, voltage: ArrayLike | None = None, start: float = 0.0, sample_time: float = 1e-3
    ) -> dict[str, Array]:
        """Signals along a trajectory (samples, states): every state, `effort` [N] and the observed signals.

        `effort` = A_a p_a - A_b p_b - p_atm (A_a - A_b), the signal of the contract, with the atmosphere's pressure on
        a side that is no chamber; the others as in `signals`.
        voltage (samples,) or one for all, None for 0. Raises UsageError for too few.
        """
        X = np.array(states, dtype=float, ndmin=2)
        held = input_rows(voltage, self.inputs, len(X))
        observed = np.empty((len(X), len(self.composition.observed)))
        self.kernel.observe(X, self.values, held, start + sample_time * np.arange(1, len(X) + 1), observed)
        result = {name: X[:, i] for i, name in enumerate(self.states)}
        result |= {name: observed[:, i] for i, name in enumerate(self.composition.observed)}
        result["effort"] = result["drive"] if self.force_driven else self.effort(X)
        return result

    def effort(self, states: Array) -> Array:
        """Net pressure force A_a p_a - A_b p_b - p_atm (A_a - A_b) [N] for states (..., states)."""
        areas, atmosphere = (self["piston.area_a"], self["piston.area_b"]), self["air.atmospheric_pressure"]
        columns = {chamber.side: self.states.index(chamber.state) for chamber in self.chambers}
        a, b = (states[..., columns[side]] if side in columns else atmosphere for side in SIDES)
        return np.asarray(areas[0] * a - areas[1] * b - atmosphere * (areas[0] - areas[1]))

    def derivatives(self, states: ArrayLike, voltage: ArrayLike | None, time: ArrayLike = 0.0) -> Array:
        """Right-hand sides (samples, states) of the model's equations at the given states (samples, states).

        voltage as in `outputs`; time [s], (samples,) or one for all.
        """
        X = np.array(states, dtype=float, ndmin=2)
        out = np.empty_like(X)
        t = np.array(np.broadcast_to(time, len(X)), dtype=float)
        self.kernel.rates(X, self.values, input_rows(voltage, self.inputs, len(X)), t, out)
        return out

    def _state_vector(self, state: ArrayLike) -> Array:
        x = np.array(state, dtype=float)
        if x.shape != (len(self.states),) or not np.isfinite(x).all():
            raise UsageError(f"state {state!r} must hold {len(self.states)} finite numbers: {', '.join(self.states)}")
        return x


def substeps(sample_time: float, step: float) -> tuple[int, float]:
    """Number of equal steps in a sample and their length [s], at most `step` and `LONGER` of it.

    UsageError unless both are positive.
    """
    if not (math.isfinite(sample_time) and math.isfinite(step) and sample_time > 0 and step > 0):
        raise UsageError(f"sample time {sample_time} s and step {step} s must be positive")
    stride = max(1, round(sample_time / step))  # the nearest, so that a long sample loses no step
    stride += sample_time / stride > step * (1.0 + LONGER)
    return stride, sample_time / stride


def _along(library: Library, coordinate: object, frame: tuple[str, ...], values: Mapping[str, object]) -> Library:
    """The library for the coordinate of a machine; one that turns already, and its scale, stay."""
    given = coordinate if coordinate is not None or library.coordinate == LINE else library.coordinate
    found = coordinate_of(given, tuple(library.part(name) for name in frame))
    if found == library.coordinate or found == LINE:
        return library
    return library.turning(Scale.of(values, any(name in library.actuators() for name in frame)))


def _whole(voltages: int, parts: int) -> int:
    if parts < 1 or voltages % parts:
        raise UsageError(f"{voltages} voltages do not fill whole samples of {parts}")
    return voltages // parts


def _checked(composition: Composition, values: Mapping[str, object], defaults: bool) -> dict[str, float]:
    for dotted in values:
        composition.parameter(dotted)
    needed = [dotted for dotted in composition.parameters if not composition.parameter(dotted).optional]
    absent = [dotted for dotted in needed if dotted not in values]
    if absent and not defaults:
        raise UsageError(missing_parameters(composition, absent))
    checked = {}
    for dotted in composition.parameters:
        specification = composition.parameter(dotted)
        checked[dotted] = specification.check(dotted, values.get(dotted, specification.default))
    return checked


def _caution(model: Model, effect: type[Effect]) -> str | None:
    values = []
    for name in effect.functions["caution"].reads:
        owner, _, key = name.partition("__") if "__" in name else (effect.name, "", name)
        if f"{owner}.{key}" not in model.parameters:
            return None
        values.append(model.parameters[f"{owner}.{key}"])
    sentence = vars(effect)["caution"](*values)
    return f"{effect.name}: {sentence}" if sentence else None
