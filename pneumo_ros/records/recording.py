"""One run of an axis as arrays on one time base."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.environment import require_libraries
from pneumo_ros.units import KEY, LINE, TURN

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Recording:
    """Signals of one axis, all of shape (n,) on `time` unless said otherwise, SI units, absolute pressures."""

    name: str  # of the folder or file
    path: Path  # of the folder or file, as it was given
    namespace: str  # of its topics; empty where they have none
    joint_name: str  # in joint_states
    start_ns: int  # header stamp of the first sample
    time: Array  # [s] since the first sample, strictly increasing, by the header stamps of joint_states
    position: Array  # [m]
    velocity: Array | None  # [m/s], where the recording has it
    effort: Array | None  # [N], where the recording has it
    pressure_a: Array | None  # [Pa]
    pressure_b: Array | None  # [Pa]
    supply_pressure: Array | None  # [Pa]
    voltage: Array | None  # [V], in force over [time[k], time[k + 1])
    command_time: Array | None  # (m,) [s] on the clock of `time`: when each command was recorded
    command: Array | None  # (m,) [V]
    description: dict[str, Any] | None  # the last one in the recording
    warnings: tuple[str, ...]  # sentences about what is wrong with the recording and what was done about it
    load_cell: Array | None = None  # [N], measured rod force, where the recording has it
    further: Mapping[str, Array] | None = None  # what else is measured, by the names of `measured`
    command_b_time: Array | None = None  # (k,) [s] as command_time, of the valve of chamber b, where there is one
    command_b: Array | None = None  # (k,) [V]

    def __len__(self) -> int:
        return len(self.time)

    @property
    def sample_time(self) -> float:
        """Median time between samples [s]."""
        return float(np.median(np.diff(self.time)))

    @property
    def duration(self) -> float:
        """From the first to the last sample [s]."""
        return float(self.time[-1])

    @property
    def signals(self) -> dict[str, Array]:
        """Every signal on `time` (n,) by its name, SI units: those that the recording has."""
        names = (
            "position", "velocity", "effort", "pressure_a", "pressure_b", "supply_pressure", "voltage", "load_cell",
        )  # fmt: skip
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None} | dict(
            self.further or {}
        )

    def with_signals(self, signals: Mapping[str, Array], **fields: Any) -> "Recording":
        """The recording with other values of its signals, by their names in `signals`, and of other fields."""
        others = {name: signals[name] for name in self.further or () if name in signals}
        own: dict[str, Any] = {name: values for name, values in signals.items() if name not in others}
        return replace(self, **own, further={**(self.further or {}), **others}, **fields)

    def to_dataframe(self) -> "pd.DataFrame":
        """The signals as columns of a pandas data frame, over time [s]; UsageError where pandas is not installed."""
        require_libraries(("pandas",))
        import pandas as pd

        return pd.DataFrame(self.signals, index=pd.Index(self.time, name="time"))

    def __str__(self) -> str:
        rate = 1.0 / self.sample_time
        return f"{self.name}: {self.duration:.4g} s at {rate:.4g} Hz, {len(self)} samples of {', '.join(self.signals)}"

    @property
    def force_driven(self) -> bool:
        """Whether this is an axis driven by a measured force, `effort`, and not by a valve."""
        return self.voltage is None and self.effort is not None

    @property
    def pressures_drive(self) -> bool:
        """Whether chamber pressures are all that tell its drive: no effort, no imposed motion.

        Both of them; or one, where no valve fills the other chamber.
        """
        measured = sum(pressure is not None for pressure in (self.pressure_a, self.pressure_b))
        return self.effort is None and not self.imposed and measured > (self.voltage is not None)

    @property
    def imposed(self) -> bool:
        """Whether a test machine imposed the motion, as the map of an imported table says."""
        return imposed(self.description)


def with_imposed(description: dict[str, Any] | None) -> dict[str, Any]:
    """The description of a recording with a map that says `motion: imposed`."""
    plan = (description or {}).get("map")
    return {**(description or {}), "map": {**(plan if isinstance(plan, dict) else {}), "motion": "imposed"}}


def coordinate(description: dict[str, Any] | None) -> str:
    """The coordinate of the machine, or of the imported table, of a description; along a line where it says nothing."""
    machine, units = ((description or {}).get(name) for name in ("model", "units"))
    turns = isinstance(machine, dict) and machine.get(KEY) == TURN
    return TURN if turns or (isinstance(units, dict) and units.get("position") == "rad") else LINE


def imposed(description: dict[str, Any] | None) -> bool:
    """Whether the description of a recording holds a map that says `motion: imposed`."""
    plan = (description or {}).get("map")
    return isinstance(plan, dict) and plan.get("motion") == "imposed"
