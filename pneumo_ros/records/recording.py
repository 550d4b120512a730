"""One run of an axis as arrays on one time base."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.environment import require_libraries

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Recording:
    """Signals of one axis, all of shape (n,) on `time` unless said otherwise, SI units, absolute pressures."""

    name: str  # of the folder or file
    path: Path
    namespace: str
    joint_name: str
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
        return {name: getattr(self, name) for name in names if getattr(self, name) is not None}

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
        """Whether the two chamber pressures are all that tell its drive: no effort, no imposed motion."""
        alone = self.effort is None and not self.imposed
        return alone and self.pressure_a is not None and self.pressure_b is not None

    @property
    def imposed(self) -> bool:
        """Whether a test machine imposed the motion, as the map of an imported table says."""
        return imposed(self.description)


def imposed(description: dict[str, Any] | None) -> bool:
    """Whether the description of a recording holds a map that says `motion: imposed`."""
    plan = (description or {}).get("map")
    return isinstance(plan, dict) and plan.get("motion") == "imposed"
