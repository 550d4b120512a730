"""Compiling the kernel of a new composition while the old one runs on."""

import json
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from pneumo_ros.axis.simulator.force_input import pushed
from pneumo_ros.plant import Model

# Numba blocks the interpreter for seconds, so another process compiles into the kernel cache; loading from it takes
# milliseconds. One sample and its outputs use every function of the kernel that a simulation uses.
_PROGRAM = """
import json, sys
import numpy as np
from pneumo_ros.plant import Library, model_from_dict
given = json.load(sys.stdin)
model = model_from_dict(given["model"], "model", Library(given["files"]))
rest = np.zeros((1, len(model.inputs)))
model.outputs(model.simulate(rest, model.state()), rest)
"""


class Compiler:
    """Compiles models one after the other in a thread and a process of its own; only the last one asked for counts."""

    def __init__(self, files: Iterable[str | Path], done: Callable[[Model, Exception | None], None]) -> None:
        """`files` are the user's effect files; `done` is called in the thread with a model whose kernel is ready,
        or with the reason why there is none.
        """
        self._files, self._done = [str(path) for path in files], done
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
        model = pushed(model)  # as a simulation steps it
        given = json.dumps({"model": model.as_dict(), "files": self._files})
        # a failure there happens again, and is reported, when the kernel is loaded here
        subprocess.run([sys.executable, "-c", _PROGRAM], input=given, text=True, capture_output=True, check=False)
        try:
            rest = np.zeros((1, len(model.inputs)))
            model.outputs(model.simulate(rest, model.state()), rest)
        except Exception as failure:  # numba's, about a user's effect: it can be of any class
            return failure
        return None
