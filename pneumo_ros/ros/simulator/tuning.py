"""Changes of a running machine through ROS parameters: checked together, applied between two samples."""

import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from rclpy.impl.rcutils_logger import RcutilsLogger

from pneumo_ros.axis.simulator.compiling import Compiler
from pneumo_ros.axis.simulator.machine import changed, check_live
from pneumo_ros.axis.simulator.settings import EFFECTS, machine_settings
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.errors import UsageError
from pneumo_ros.multiaxis import Machine
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import closed_signal, second_closed
from pneumo_ros.ros.parameters import Parameters, Values

_SENSORS = (
    "noise_position", "noise_pressure", "quantisation_position", "quantisation_pressure", "publish_velocity",
)  # fmt: skip


class Tuning:
    """Applies parameters to a simulation. A new list of effects is compiled first, while the old one runs."""

    def __init__(
        self,
        parameters: Parameters,
        simulation: Simulation,
        lock: threading.Lock,
        logger: RcutilsLogger,
        adopted: Callable[[], None],
        effects_files: Iterable[str | Path],
        whole: Callable[[Model], Model | Machine] = lambda model: model,
    ) -> None:
        """`lock` is held while the simulation is touched; `adopted` is called after every change of the machine.

        `whole`: see `Compiler`.
        """
        self._parameters, self._simulation, self._lock = parameters, simulation, lock
        self._logger, self._adopted = logger, adopted
        self._wanted = simulation.model
        self.compiler = Compiler(effects_files, self._compiled, whole)
        self._take_settings(parameters.values())
        parameters.check, parameters.apply = self._check, self._apply

    def _check(self, values: Values) -> None:
        model = changed(self._wanted, values)
        model.state(**initial_state(values))
        if model is not self._wanted:
            check_live(model, self._wanted, float(self._simulation.plant.state[0]))
        if values["max_voltage"] <= 0.0:
            raise UsageError("max_voltage is 0 V; it takes a positive number")

    def _apply(self, values: Values) -> None:
        before, self._wanted = self._wanted, changed(self._wanted, values)
        self._take_settings({**self._parameters.values(), **values})
        if self._wanted is before:
            return
        if self._wanted.effects != before.effects:
            self._redeclare(before)
        if self._wanted.composition.text == self._simulation.model.composition.text:
            self._swap(self._wanted)
        else:
            self._logger.info(f"compiling {', '.join(self._wanted.effects)}; the present machine runs on")
            self.compiler.compile(self._wanted)

    def _redeclare(self, before: Model) -> None:
        """Undeclare parameters of removed effects, and declare those of new ones."""
        now = self._wanted.parameters
        self._parameters.undeclare([name for name in before.parameters if name not in now])
        new = [name for name in now if name not in before.parameters]
        self._parameters.declare(machine_settings(self._wanted, new))

    def _compiled(self, model: Model, failure: Exception | None) -> None:
        if failure is not None:
            self._logger.error(f"{', '.join(model.effects)} cannot be compiled: {failure}")
            model, self._wanted = self._wanted, self._simulation.model
            self._redeclare(model)
            self._parameters.update({EFFECTS: list(self._wanted.effects)})
            return
        self._swap(self._wanted if self._wanted.composition.text == model.composition.text else model)
        self._logger.info(f"the machine now consists of {', '.join(model.effects)}")

    def _swap(self, model: Model) -> None:
        with self._lock:
            self._simulation.replace(model)
            self._simulation.valve.close_at(closed_signal(model))
            self._simulation.valve_b.close_at(second_closed(model) or 0.0)
        for sentence in model.cautions():
            self._logger.warning(sentence)
        self._adopted()

    def _take_settings(self, values: Values) -> None:
        simulation = self._simulation
        simulation.initial = initial_state(values)
        for valve in (simulation.valve, simulation.valve_b):
            valve.max_voltage, valve.timeout = values["max_voltage"], values["command_timeout"]
        simulation.force.timeout = values["force_timeout"]
        for name in _SENSORS:
            setattr(simulation.sensors, name, values[name])


def initial_state(values: Values) -> dict[str, Any]:
    """Entries of the initial state that the parameters `initial.*` give."""
    given = {name.partition(".")[2]: value for name, value in values.items() if name.startswith("initial.")}
    return {name: value for name, value in given.items() if value != 0.0 or name in ("y", "v")}
