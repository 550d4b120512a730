"""A machine of several axes, each a model of its own, on one supply; immutable, like its models."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.multiaxis.drawing import MEASURED, drawing_model
from pneumo_ros.multiaxis.kernel import SUPPLY_PARAMETERS, machine_kernel
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant import Model
from pneumo_ros.plant.axes_section import AXES, SUPPLY
from pneumo_ros.plant.held import held_inputs
from pneumo_ros.plant.model import STEP, substeps

Array = NDArray[np.float64]
STIFF = (0.0, 1.0)  # resistance and time constant of a supply that never drops


@dataclass(frozen=True)
class Machine:
    """Axes by prefix, in order, and the `supply` line that they share.

    supply: parameters of `supply_pressure_droop`, resistance [Pa s/kg] and time constant [s], of the flow that all
    axes draw together; None where every axis has a stiff supply.
    """

    name: str
    axes: Mapping[str, Model]
    supply: Mapping[str, float] | None = None

    def __post_init__(self) -> None:
        if not self.axes:
            raise UsageError("a machine has at least one axis")
        if self.supply is not None and not any(MEASURED in one.inputs for one in self.drawing.values()):
            raise UsageError("supply_pressure_droop beside the axes: none of them draws air from a supply")

    def axis(self, name: str) -> Model:
        """One axis by its prefix; UsageError with the nearest names."""
        if name not in self.axes:
            raise UsageError(unknown_name("axis", name, self.axes))
        return self.axes[name]

    def with_axes(self, axes: Mapping[str, Model]) -> "Machine":
        """The same machine with other models of some of its axes; UsageError for unknown prefixes."""
        for name in axes:
            self.axis(name)
        return replace(self, axes={name: axes.get(name, one) for name, one in self.axes.items()})

    def with_supply(self, supply: Mapping[str, float] | None) -> "Machine":
        """The same axes on another supply line; None for a stiff one."""
        return replace(self, supply=supply)

    def as_dict(self) -> dict[str, object]:
        """The machine file as a nested dictionary: axes, the supply that they share, and the sections of each."""
        line: dict[str, object] = {} if self.supply is None else {SUPPLY: dict(self.supply)}
        return {AXES: list(self.axes), **line, **{name: one.as_dict() for name, one in self.axes.items()}}

    @cached_property
    def drawing(self) -> dict[str, Model]:
        """The axes with their supply as an input and the drawn mass [kg] as their last state."""
        return {name: drawing_model(one) for name, one in self.axes.items()}

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states: those of each axis with its prefix, the air that it drew, and the supply's drop d_s."""
        return *(f"{axis}/{s}" for axis, one in self.drawing.items() for s in one.states), "d_s"

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of the held inputs, with the prefixes of their axes."""
        return tuple(f"{axis}/{n}" for axis, one in self.drawing.items() for n in one.inputs if n != MEASURED)

    @cached_property
    def kernel(self) -> ModuleType:
        """The compiled module: `run` for all axes together."""
        return machine_kernel([one.composition for one in self.drawing.values()])

    @property
    def values(self) -> Array:
        """Parameter vector in kernel order, all axes begun at 0 s; a fresh copy."""
        line = STIFF if self.supply is None else tuple(self.supply[name] for name in SUPPLY_PARAMETERS)
        return np.concatenate([*(one.values for one in self.axes.values()), line, np.zeros(len(self.axes))])

    def state(self, axes: Mapping[str, ArrayLike] | None = None) -> Array:
        """State vector (states,): each axis as given (states of its model,), others at rest; a full supply."""
        given = {name: np.asarray(x, dtype=float) for name, x in (axes or {}).items()}
        parts: list[Array] = []
        for name, model in self.axes.items():
            x = given.get(name, model.state())
            if x.shape != (len(model.states),):
                raise UsageError(f"state of {name} has shape {x.shape}; it takes {len(model.states)}: {model.states}")
            parts += [x, np.zeros(1)]
        return np.concatenate([*parts, np.zeros(1)])

    def split(self, states: Array) -> dict[str, Array]:
        """The states of each axis's own model, from states (..., states) of the machine."""
        result, at = {}, 0
        for name, model in self.axes.items():
            result[name] = states[..., at : at + len(model.states)]
            at += len(model.states) + 1
        return result

    def supply_pressure(self, axis: str, states: Array) -> Array:
        """Supply pressure at the valve of `axis` [Pa] for states (..., states) of the machine."""
        return np.asarray(self.axis(axis)["air.supply_pressure"] - states[..., -1])

    def simulate(
        self, inputs: ArrayLike, state: ArrayLike, *, sample_time: float = 1e-3, step: float = STEP,
        start: float = 0.0, parts: int = 1,
    ) -> Array:  # fmt: skip
        """As `Model.simulate`, for all axes at once: inputs (samples * parts, inputs); returns (samples, states).

        Raises NumericalError, with the time, when a state leaves the finite numbers, UsageError for other shapes.
        """
        held, x = held_inputs(inputs, self.inputs), np.array(state, dtype=float)
        if x.shape != (len(self.states),) or len(held) % parts:
            raise UsageError(f"state {x.shape} and inputs {held.shape} do not fit {len(self.states)} states")
        out = np.empty((len(held) // parts, len(x)))
        stride, h = substeps(sample_time / parts, step)
        self.kernel.run(x, self.values, held, start, h, stride, parts, out)
        if not math.isfinite(float(x.sum())):
            bad = int(np.argmin(np.isfinite(out).all(axis=1)))
            raise NumericalError(
                f"the state of {self.name} left the finite numbers at t = {start + bad * sample_time:.3f} s"
            )
        return out


def same_supply(axes: Sequence[Model]) -> float | None:
    """The supply pressure [Pa] that all these axes have; None where they differ or one has none."""
    found = {one.parameters.get("air.supply_pressure") for one in axes}
    return found.pop() if len(found) == 1 else None
