"""A rig in simulation: the conductor's own trials on a machine, with noise, and plugs that may be wrong."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.commission.performing import Performed
from pneumo_ros.errors import PneumoError
from pneumo_ros.experiment.conductor import Conductor
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.whitened import Noise
from pneumo_ros.plant import Model
from pneumo_ros.plant.stepper import Stepper
from pneumo_ros.reading.read import ATMOSPHERE
from pneumo_ros.records import Recording
from pneumo_ros.records.corrections import wiring

Array = NDArray[np.float64]


@dataclass
class SimulatedRig:
    """`truth` behind sensors with `noise`, wired as `words` of --read-as say; `farthest` [m] it was from mid stroke."""

    truth: Model
    words: Sequence[str] = ()
    sample_time: float = 2e-3  # [s]
    noise: Noise = field(default_factory=Noise)
    seed: int = 0
    position: float = 0.0  # [m] at the start
    farthest: float = 0.0

    def __post_init__(self) -> None:
        self._plant = Stepper(self.truth, self.truth.state(y=self.position), sample_time=self.sample_time)
        self._random = np.random.default_rng(self.seed)

    def perform(self, programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        """Run the programme, the commands sent as `words` say; recordings are as the rig's sensors read."""
        conductor, read, real = Conductor(programme), wiring(words), wiring(self.words)
        trials: dict[str, list[tuple[float, ...]]] = {}
        begin, reason = self._plant.time, ""
        atmosphere = self.truth.parameters.get("air.atmospheric_pressure", ATMOSPHERE)
        try:
            while not conductor.done:
                y, _v, a, b = (float(x) for x in self._plant.state[:4])
                self.farthest = max(self.farthest, abs(y))
                noise = self._random.normal(size=3)
                seen = real.shown_position(y + self.noise.position * noise[0])
                volts = conductor.step(self._plant.time, read.position(seen))
                sent = read.command(programme.closed + volts)
                if conductor.recording:
                    a, b = (p + self.noise.pressure * e for p, e in zip((a, b), noise[1:], strict=True))
                    pressures = real.shown_pressures(a, b, atmosphere)
                    trials.setdefault(conductor.recording, []).append((self._plant.time, seen, *pressures, sent))
                self._plant.advance(real.volts(sent))
        except PneumoError as error:
            reason = str(error)
        finished = {one.name for one in conductor.outcomes}
        made = tuple(_recording(f"{name}_{k}", np.array(rows)) for k, rows in trials.items() if k in finished)
        return Performed(made, self._plant.time - begin, reason)


def _recording(name: str, rows: Array) -> Recording:
    """A recording of (n, 5): time [s], position, both pressures, command."""
    time, position, first, second, sent = rows.T
    time = time - time[0]
    changed = np.flatnonzero(np.diff(sent, prepend=np.nan) != 0.0)
    return Recording(
        name=name, path=Path(name), namespace="", joint_name="piston", start_ns=0, time=time, position=position,
        velocity=None, effort=None, pressure_a=first, pressure_b=second, supply_pressure=None, voltage=sent,
        command_time=time[changed], command=sent[changed], description=None, warnings=(),
    )  # fmt: skip
