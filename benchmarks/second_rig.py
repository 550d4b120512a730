"""The second simulator, which shares no code with the package, in the role of a rig that is commissioned."""

import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.commission.simulated import SimulatedRig
from pneumo_ros.plant import Model, load_model

sys.path.insert(0, str(Path(__file__).parents[1] / "test"))

from rig.loop import STEP, integrate, rest
from rig.machine import SMOOTH, Machine, packed, worn
from rig.rates import STATES

Array = NDArray[np.float64]
WORN = {  # field of the second simulator -> parameter of a machine file
    "dead_right": "dead_zone.right_limit", "dead_left": "dead_zone.left_limit", "gain": "arctan_flow.voltage_gain",
    "fill": "arctan_flow.filling_coefficient", "exhaust": "arctan_flow.exhaust_coefficient",
    "static": "lugre_friction.static_friction", "coulomb": "lugre_friction.coulomb_friction",
    "stribeck": "lugre_friction.stribeck_velocity", "bristle": "lugre_friction.bristle_stiffness",
    "drag": "quadratic_drag.coefficient",
}  # fmt: skip
SCATTER, STATED = 0.2, 0.12  # share by which a machine is off at most, evenly; the deviation that its file states


class SecondPlant:
    """Stands in the place of the package's stepper: `state` (y, v, p_a, p_b), `time`, `advance`."""

    def __init__(self, machine: Machine, position: float, sample_time: float) -> None:
        self.machine, self.sample_time, self.time = machine, sample_time, 0.0
        self._packed, self._x = packed(machine), rest(machine, position, machine.atmosphere)
        self._steps = round(sample_time / STEP)
        self._out, self._applied = np.empty((1, len(STATES))), np.empty(1)

    @property
    def state(self) -> Array:
        """Position [m], velocity [m/s], both pressures [Pa]."""
        m, x = self.machine, dict(zip(STATES, self._x, strict=True))
        rooms = (m.volume_a + m.area_a * x["y"], m.volume_b - m.area_b * x["y"])
        p_a, p_b = ((m.adiabatic - 1.0) * x[f"energy_{side}"] / room for side, room in zip("ab", rooms, strict=True))
        return np.array([x["y"], x["v"], p_a, p_b])

    def advance(self, volts: float) -> Array:
        """One sample at `volts` [V]; the state after it."""
        integrate(
            self._packed, SMOOTH, self._x, np.array([volts]), np.array([np.nan]), np.zeros(1), np.inf, self._steps,
            self.sample_time, self._out, self._applied,
        )  # fmt: skip
        self.time += self.sample_time
        return self.state


@dataclass
class SecondRig(SimulatedRig):
    """A rig whose plant is the second simulator; `truth` names the values that it has."""

    machine: Machine = field(default_factory=Machine)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._plant = SecondPlant(self.machine, self.position, self.sample_time)  # type: ignore[assignment]


def file_of() -> Model:
    """The default machine as a data sheet would know it: everything that wears is uncertain."""
    axis = load_model("axis")
    return axis.with_uncertainty({name: STATED * axis[name] for name in WORN.values()})


def second_rig(seed: int, words: tuple[str, ...] = ()) -> SecondRig:
    """A rig of the second simulator, worn by up to 20 %, somewhere in the middle of its stroke."""
    random, sheet = np.random.default_rng(seed), file_of()
    machine = worn(Machine(), random, SCATTER)
    machine = machine._replace(static=max(machine.static, 1.05 * machine.coulomb))
    truth = sheet.with_parameters({name: getattr(machine, field) for field, name in WORN.items()})
    position = float(random.uniform(-0.4, 0.4))
    return SecondRig(truth, words, seed=seed, position=position, machine=machine)
