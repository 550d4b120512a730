"""Work for the tests of sweeps: functions of a module, as worker processes need them."""

import os
import signal
import time
from pathlib import Path

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.plant import load_model


def moved(volts: float) -> list[float]:
    """State of the default axis after 50 ms at a constant voltage, to the bit."""
    model = load_model("axis")
    return [float(value) for value in model.simulate(np.full(50, volts), model.state())[-1]]


def counted(folder: str, name: str) -> str:
    """`name`, after a mark in `folder` that counts the calls."""
    with Path(folder, name).open("a") as file:
        file.write("x")
    return name


def dies_once(folder: str, name: str) -> str:
    """Kills its process when it is called for the first time."""
    if name == "deadly" and not Path(folder, "dead").exists():
        Path(folder, "dead").touch()
        time.sleep(0.3)  # others are under way
        os.kill(os.getpid(), signal.SIGKILL)
    return counted(folder, name)


def dies_always(folder: str, name: str) -> str:
    """Kills its process for the deadly name."""
    if name == "deadly":
        os.kill(os.getpid(), signal.SIGKILL)
    return counted(folder, name)


def fails(name: str) -> str:
    """Fails as unfit data of a user, or as a defect of the program."""
    if name == "unfit":
        raise DataError("this recording is unfit")
    if name == "wrong":
        raise ZeroDivisionError("a mistake of the program")
    return name
