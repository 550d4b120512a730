"""FMUs of machines, and how FMPy steps them."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from pneumo_ros.export import Exported, fmu_archive
from pneumo_ros.plant import Model
from pneumo_ros.plant.machine_file import machine_text

fmpy = pytest.importorskip("fmpy", reason="FMPy is missing; type: pip install fmpy")
VERSIONS = (2, 3)
SAMPLE = 1e-3


def written(model: Model, version: int, folder: Path) -> Path:
    """The FMU of a machine as a file."""
    path = folder / f"{model.name}_{version}.fmu"
    path.write_bytes(_archive(Exported(model), machine_text(model), version))
    return path


_made: dict[tuple[str, int], bytes] = {}  # the compiler takes a second for each


def _archive(machine: Exported, text: str, version: int) -> bytes:
    if (text, version) not in _made:
        _made[text, version] = fmu_archive(machine, version)
    return _made[text, version]


class Running:
    """An FMU in co-simulation: variables by name; `told` holds its messages."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.description = fmpy.read_model_description(str(path))
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.three = self.description.fmiVersion.startswith("3")
        unpacked = fmpy.extract(str(path), str(folder / f"{path.stem}_unpacked"))
        given = {"guid": self.description.guid, "unzipDirectory": unpacked, "instanceName": "axis"}
        kind = fmpy.fmi3.FMU3Slave if self.three else fmpy.fmi2.FMU2Slave
        self.fmu: Any = kind(modelIdentifier=self.description.coSimulation.modelIdentifier, **given)
        self.told: list[str] = []
        self.fmu.instantiate(**({"logMessage": self._log3()} if self.three else {"callbacks": self._log2()}))

    def _log2(self) -> Any:
        callbacks = fmpy.fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmpy.fmi2.fmi2CallbackLoggerTYPE(lambda *words: self.told.append(str(words)))
        callbacks.allocateMemory = fmpy.fmi2.fmi2CallbackAllocateMemoryTYPE(fmpy.fmi2.calloc)
        callbacks.freeMemory = fmpy.fmi2.fmi2CallbackFreeMemoryTYPE(fmpy.fmi2.free)
        self.callbacks = callbacks
        return callbacks

    def _log3(self) -> Any:
        return lambda *words: self.told.append(str(words))

    def start(self, **values: float) -> None:
        """Initialise with these values, dots in their names written as two underscores."""
        for name, value in values.items():
            self.set(name.replace("__", "."), value)
        if not self.three:
            self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def set(self, name: str, value: float) -> None:
        """Set a variable."""
        (self.fmu.setFloat64 if self.three else self.fmu.setReal)([self.references[name]], [value])

    def get(self, *names: str) -> list[float]:
        """Values of variables."""
        references = [self.references[name] for name in names]
        return list((self.fmu.getFloat64 if self.three else self.fmu.getReal)(references))

    def step(self, time: float, length: float = SAMPLE) -> None:
        """One communication step."""
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=length)

    def run(self, voltage: np.ndarray, *names: str) -> np.ndarray:
        """Values of `names` (samples, names) at the end of each sample in which one input is held."""
        out = np.empty((len(voltage), len(names)))
        for k, level in enumerate(voltage):
            self.set("U", float(level))
            self.step(k * SAMPLE)
            out[k] = self.get(*names)
        return out


@contextmanager
def running(model: Model, version: int, folder: Path) -> Iterator[Running]:
    """A fresh instance of a machine."""
    instance = Running(written(model, version, folder), folder)
    try:
        yield instance
    finally:
        instance.fmu.freeInstance()
