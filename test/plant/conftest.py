"""Kernels of all effects, compiled in a second process while the tests that need none run."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

_PROGRAM = """
import numpy as np
from plant.catalogue import CATALOGUE, lone_machine, machine, moves_piston
for effect in CATALOGUE:
    model = machine(effect.name)
    model.simulate(np.zeros(0), model.state())
    if moves_piston(effect):
        model = lone_machine(effect.name)
        model.outputs(model.follow(np.zeros((1, 4)), np.zeros(0), model.state()[4:])[0])
"""


@pytest.fixture(scope="session")
def compiling() -> Iterator["subprocess.Popen[bytes]"]:
    """The process that compiles; wait for it before running what it compiles."""
    paths = [
        str(Path(__file__).parent.parent),
        str(Path(__file__).parent.parent.parent),
        os.environ.get("PYTHONPATH", ""),
    ]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
    process = subprocess.Popen([sys.executable, "-c", _PROGRAM], env=environment)
    yield process
    process.kill()
    process.wait()
