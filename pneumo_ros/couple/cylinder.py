"""A cylinder beside a rigid-body simulator: it integrates the piston itself within the simulator's step.

A force that is computed once at the start of a step treats gas and bristles as if they did not feel the motion: at
steps of a rigid-body simulator their stiffness then pumps energy into the arm. Here the piston moves within the step as
the arm lets it: with the effective mass m = 1/(J M^-1 J^T) of the arm at the rod (Khatib 1987, A unified approach for
motion and force control, eq. 51) and the acceleration a that the arm would have without the cylinder,

    m v' = m a + F(y, v, pressures, bristles).

F's mean over the step, m ((v1 - v0)/dt - a), gives the arm the same velocity at the end of the step.
"""

import math

import numpy as np

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.plant.model import STEP, Model

LOAD, MASS = "constant_load.load", "piston.mass"
OF_THE_ARM = (
    "constant_load",
    "payload_mass",
    "arm_load",
    "imposed_motion",
    "measured_load",
)  # effects that the mechanism replaces


class Cylinder:
    """Chambers, valve and friction of a machine; mass and load are those of the mechanism that it moves.

    `state` (states,) holds the machine's states in the order of `model.states`: y [m], v [m/s], p_a, p_b [Pa], further.
    """

    def __init__(self, model: Model, *, position: float = 0.0, step: float = STEP) -> None:
        """At rest at `position` [m], chambers at atmospheric pressure; integrated in steps no longer than `step` [s].

        Compiles the kernel. Raises UsageError for a machine without chambers or whose effects read measured signals,
        and for a position outside the stroke.
        """
        if model.force_driven or model.inputs[1:]:
            raise UsageError(
                f"{model.name} cannot be coupled: it takes a machine file with a section 'chambers', whose effects "
                "read no measured signals, and one valve command"
            )
        model.require_metres("coupling")
        model.require_two_chambers("coupling")
        kept = [name for name in model.effects if name not in OF_THE_ARM]
        self.model = model.with_effects([*kept, "constant_load"], {LOAD: 0.0})
        self.step_most = step
        self.state = self.model.state(y=position)
        self.time = 0.0
        names = list(self.model.parameters)
        self._mass, self._load = names.index(MASS), names.index(LOAD)
        self._values = self.model.values.copy()
        self._inputs, self._out = np.zeros((1, 1)), np.empty((1, len(self.state)))
        self._run = self.model.kernel.run
        known = ("chambers.volume_a", "piston.area_a", "chambers.volume_b", "piston.area_b", "air.heat_capacity_ratio")
        self._volumes = tuple(self.model[name] for name in known)
        self.step(position, 0.0, 1.0, 0.0, step, 0.0)  # compiles
        self.reset(position)

    def reset(self, position: float = 0.0, **states: float) -> None:
        """Back to time 0, at rest at `position` [m]; further `states` by name, such as p_a [Pa]."""
        self.state[:] = self.model.state(y=position, **states)
        self.time = 0.0

    def pressurise(self, pressure_a: float, pressure_b: float) -> None:
        """Set both chamber pressures [Pa abs]; UsageError unless both are finite and above 0."""
        for value in (pressure_a, pressure_b):
            if not (math.isfinite(value) and value > 0.0):
                raise UsageError(f"a pressure is {value}; it takes absolute pascals above 0")
        self.state[2:4] = pressure_a, pressure_b

    def step(
        self,
        position: float,
        velocity: float,
        effective_mass: float,
        free_acceleration: float,
        time_step: float,
        voltage: float,
    ) -> float:
        """Mean force [N] of the cylinder on the mechanism over the next `time_step` [s], above 0 where it extends.

        `position` [m] (0 at mid stroke) and `velocity` [m/s] of the rod now; `effective_mass` [kg] of the mechanism
        along the rod, and its `free_acceleration` [m/s2] without this cylinder, gravity and all else included; valve
        `voltage` [V], held. Chambers, bristles and valve go on to the end of the step. Raises UsageError for a number
        that is not finite or a mass or step that is not above 0, NumericalError when the state leaves the finite
        numbers; the state then stays.
        """
        if not math.isfinite(position + velocity + free_acceleration + voltage):
            given = (position, velocity, effective_mass, free_acceleration, time_step, voltage)
            raise UsageError(f"the step is given {given}; it takes finite numbers")
        if not (0.0 < effective_mass < math.inf and 0.0 < time_step < math.inf):
            raise UsageError(f"mass {effective_mass} kg and step {time_step} s take finite numbers above 0")
        state, values = self.state, self._values
        before = state.copy()
        self.follow(position)
        state[1] = velocity
        values[self._mass], values[self._load] = effective_mass, -effective_mass * free_acceleration
        self._inputs[0, 0] = voltage
        count = max(1, math.ceil(time_step / self.step_most - 1e-9))
        self._run(state, values, self._inputs, self.time, time_step / count, count, 1, self._out)
        end = float(state[1])
        if not math.isfinite(end + float(state.sum())):
            state[:] = before
            raise NumericalError(f"the cylinder's state left the finite numbers at t = {self.time:.4f} s")
        self.time += time_step
        return effective_mass * ((end - velocity) / time_step - free_acceleration)

    def follow(self, position: float) -> None:
        """Bring the piston to `position` [m], where the mechanism has it: the gas follows along its isentropes.

        The two differ by the order of the simulator's integrator, a dt^2/2; the gas must not gain energy by it.
        """
        state, m = self.state, self._volumes
        shift, y = position - float(state[0]), float(state[0])
        if not shift:
            return
        after_a, after_b = m[0] + m[1] * position, m[2] - m[3] * position
        if min(after_a, after_b) <= 0.0:
            raise NumericalError(
                f"the mechanism holds the rod at {position:.4g} m, where a chamber has no volume left; its stroke is "
                f"+-{0.5 * self.model['piston.stroke']:g} m: take a shorter step, or limit the mechanism"
            )
        state[2] *= ((m[0] + m[1] * y) / after_a) ** m[4]
        state[3] *= ((m[2] - m[3] * y) / after_b) ** m[4]
        state[0] = position

    @property
    def pressures(self) -> tuple[float, float]:
        """Absolute pressures of the chambers a and b [Pa]."""
        return float(self.state[2]), float(self.state[3])

    def energy(self) -> float:
        """Energy [J] that the gas and the atmosphere can still give up: p V/(kappa - 1), and p_atm on the rod.

        Internal energy of an ideal gas; without flow and heat, F v = -dE/dt but for friction.
        """
        m, y = self.model, float(self.state[0])
        volume_a = m["chambers.volume_a"] + m["piston.area_a"] * y
        volume_b = m["chambers.volume_b"] - m["piston.area_b"] * y
        inner = sum(p * v for p, v in zip(self.pressures, (volume_a, volume_b), strict=True))
        difference = m["piston.area_a"] - m["piston.area_b"] if "rod_atmospheric_force" in m.effects else 0.0
        atmosphere = m["air.atmospheric_pressure"] * difference * y
        return inner / (m["air.heat_capacity_ratio"] - 1.0) + atmosphere
