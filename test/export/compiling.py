"""An exported machine compiled by the C compiler of this computer, with every warning an error."""

import ctypes
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.export import Exported, c_files
from pneumo_ros.plant import Model

COMPILER = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="no C compiler; type: sudo apt install gcc")
STRICT = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
SAMPLE, STRIDE = 1e-3, 10


@dataclass
class Compiled:
    """The functions of an exported machine; its structs are rows of doubles."""

    machine: Exported
    library: ctypes.CDLL

    def call(self, name: str, *arguments: np.ndarray | float | int) -> None:
        """Call a function: arrays are structs, floats doubles, and whole numbers unsigned long."""
        kinds = {float: ctypes.c_double, int: ctypes.c_ulong}
        given = [
            a.ctypes.data_as(ctypes.c_void_p) if isinstance(a, np.ndarray) else kinds[type(a)](a) for a in arguments
        ]
        function = self.library[f"{self.machine.prefix}_{name}"]
        function.restype = None
        function(*given)

    def held(self, level: float) -> np.ndarray:
        """The inputs, all 0 but the voltage or force."""
        return np.array([level if variable.name == "U" else 0.0 for variable in self.machine.inputs])

    def defaults(self) -> np.ndarray:
        """The parameters that the file itself carries."""
        values = np.full(len(self.machine.parameters), np.nan)
        self.call("parameters_default", values)
        return values

    def start(self, parameters: np.ndarray) -> np.ndarray:
        """Time and state that `init` sets."""
        state = np.full(1 + len(self.machine.states), np.nan)
        self.call("init", state, parameters)
        return state

    def run(self, voltage: np.ndarray, start: np.ndarray, parameters: np.ndarray | None = None) -> np.ndarray:
        """States (samples, states) at the end of each sample in which one voltage is held."""
        q = self.defaults() if parameters is None else parameters
        state = np.concatenate([[0.0], start])
        out = np.empty((len(voltage), len(start)))
        for k, level in enumerate(voltage):
            state[0] = k * STRIDE * (SAMPLE / STRIDE)
            self.call("advance", state, self.held(level), q, SAMPLE / STRIDE, STRIDE)
            out[k] = state[1:]
        return out


def compiled(model: Model, folder: Path) -> Compiled:
    """Write, compile and load a machine."""
    machine, folder = Exported(model), Path(tempfile.mkdtemp(dir=folder))  # a library is loaded once for each path
    header, source = c_files(machine, f"{machine.prefix}.h")
    (folder / f"{machine.prefix}.h").write_text(header, encoding="utf-8")
    path, library = folder / f"{machine.prefix}.c", folder / f"{machine.prefix}.so"
    path.write_text(source, encoding="utf-8")
    assert COMPILER is not None
    done = subprocess.run(
        [COMPILER, *STRICT, "-shared", "-fPIC", str(path), "-o", str(library), "-lm"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return Compiled(machine, ctypes.CDLL(str(library)))


def largest_difference(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Largest difference over the size that each state reaches."""
    size = np.maximum(np.abs(ours).max(axis=0), 1e-300)
    return float((np.abs(ours - theirs) / size).max())
