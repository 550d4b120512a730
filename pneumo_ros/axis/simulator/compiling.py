"""Compiling the kernel of a new composition while the old one runs on."""

import json
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from pneumo_ros.axis.simulator.force_input import pushed
from pneumo_ros.multiaxis import Machine
from pneumo_ros.multiaxis.machine_file import machine_from_dict
from pneumo_ros.plant import Library, Model, model_from_dict
from pneumo_ros.plant.axes_section import AXES

# Numba blocks the interpreter for seconds, so another process compiles into the kernel cache; loading from it takes
# milliseconds. One sample and its outputs use every function of the kernel that a simulation uses.
_PROGRAM = """
import json, sys
from pneumo_ros.axis.simulator.compiling import compile_dict
compile_dict(**json.load(sys.stdin))
"""


def compile_dict(model: dict[str, Any], files: list[str]) -> None:
    """Compile, or load, what steps the machine of this nested dictionary, of one axis or several."""
    library = Library(files)
    use(machine_from_dict(model, "model", library) if AXES in model else model_from_dict(model, "model", library))


def use(machine: Model | Machine) -> None:
    """Step a machine once and read its sensors: afterwards its kernel is there."""
    axes = [machine] if isinstance(machine, Model) else list(machine.axes.values())
    for model in axes:
        rest = np.zeros((1, len(model.inputs)))
        model.outputs(model.simulate(rest, model.state()), rest)
    if isinstance(machine, Machine):
        machine.simulate(np.zeros((1, len(machine.inputs))), machine.state())


class Compiler:
    """Compiles models one after the other in a thread and a process of its own; only the last one asked for counts."""

    def __init__(
        self, files: Iterable[str | Path], done: Callable[[Model, Exception | None], None],
        whole: Callable[[Model], Model | Machine] = lambda model: model,
    ) -> None:  # fmt: skip
        """`files` are the user's effect files; `done` is called in the thread with a model whose kernel is ready,
        or with the reason why there is none. `whole`: the machine of several axes with such a model of one of them.
        """
        self._files, self._done, self._whole = [str(path) for path in files], done, whole
        self._wanted: Model | None = None
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None

    @property
    def busy(self) -> bool:
        """Whether a kernel is being compiled."""
        return self._thread is not None

    def compile(self, model: Model) -> None:
        """Start compiling; returns at once."""
        with self._lock:
            self._wanted = model
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="compiler", daemon=True)
                self._thread.start()

    def _work(self) -> None:
        while True:
            with self._lock:
                model, self._wanted = self._wanted, None
                if model is None:
                    self._thread = None
                    return
            failure = self._compile(model)
            if self._wanted is None:
                self._done(model, failure)

    def _compile(self, model: Model) -> Exception | None:
        machine = self._whole(pushed(model))  # as a simulation steps it
        given = json.dumps({"model": machine.as_dict(), "files": self._files})
        # a failure there happens again, and is reported, when the kernel is loaded here
        subprocess.run([sys.executable, "-c", _PROGRAM], input=given, text=True, capture_output=True, check=False)
        try:
            use(machine)
        except Exception as failure:  # numba's, about a user's effect: it can be of any class
            return failure
        return None
