"""The interface of a control law: gains as class attributes, one `step` per measurement."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar

from pneumo_ros.control.gain import Gain
from pneumo_ros.control.machine import FLOW, Machine
from pneumo_ros.control.measurement import Measurement
from pneumo_ros.control.setpoint import Setpoint
from pneumo_ros.control.valve import ValveInverse
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name


class Law(ABC):
    """A control law. Subclasses declare their gains as class attributes and read them as `self.<gain>`.

    `valve` turns the wanted opening of the valve into its voltage, `machine` holds the known parameters of the plant;
    both may be set, and gains tuned, between steps.
    """

    gains: ClassVar[Mapping[str, Gain]] = {}
    reads_pressures: ClassVar[bool] = False  # whether `step` uses the pressures of a measurement
    inverts_flow: ClassVar[bool] = False  # whether it needs the flow law of the valve
    tuned: ClassVar[tuple[str, ...]] = ()  # gains that are found by simulation, the ones that matter most first

    def __init_subclass__(cls) -> None:
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Gain)}
        cls.gains = MappingProxyType({**own, **{n: g for n, g in cls.gains.items() if n not in own}})

    def __init__(
        self,
        gains: Mapping[str, float] | None = None,
        valve: ValveInverse | None = None,
        machine: Machine | None = None,
    ) -> None:
        """Take `gains` by name, defaults for the others.

        Raises UsageError as `tune` does, and when the law inverts the valve flow but the machine lists no `FLOW`.
        """
        self.valve, self.machine = valve or ValveInverse(), machine or Machine()
        if self.inverts_flow and not self.machine.has_flow:
            listed = ", ".join(self.machine.effects) or "no effects"
            raise UsageError(
                f"law {type(self).__name__} inverts the valve flow of {FLOW}, by itself or with choked_flow; this "
                f"machine lists {listed}: take law pid, which inverts the dead zone alone, or describe the valve by "
                f"{FLOW}"
            )
        self._time: float | None = None
        self._answer = 0.0
        self.tune({name: gain.default for name, gain in self.gains.items()} | dict(gains or {}))
        self.reset()

    def tune(self, gains: Mapping[str, float]) -> None:
        """Change all given gains, or none: UsageError, with the nearest names, for a bad one. States are kept."""
        checked = {}
        for name, value in gains.items():
            if name not in self.gains:
                raise UsageError(unknown_name("gain", name, self.gains))
            checked[name] = self.gains[name].check(name, value)
        for name, value in checked.items():
            setattr(self, name, value)

    def step(self, setpoint: Setpoint, measurement: Measurement) -> float:
        """Voltage [V] that makes the piston follow `setpoint`; call once per measurement, in order of time.

        A measurement no later than the one before is a repetition and gets the same answer.
        """
        dt = 0.0 if self._time is None else measurement.time - self._time
        if self._time is None or dt > 0.0:
            self._time, self._answer = measurement.time, self.respond(setpoint, measurement, dt)
        return self._answer

    def reset(self) -> None:
        """Forget everything but the gains."""
        self._time, self._answer = None, 0.0
        self.forget()

    @abstractmethod
    def respond(self, setpoint: Setpoint, measurement: Measurement, dt: float) -> float:
        """Voltage [V] for a measurement `dt` [s] after the last one, 0 s for the first."""

    @abstractmethod
    def forget(self) -> None:
        """Forget the states of the law itself."""
