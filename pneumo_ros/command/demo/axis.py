"""The axis on ROS 2 for a few seconds: simulator, controller and recorder run as processes."""

import time
from pathlib import Path
from typing import TYPE_CHECKING

from pneumo_ros.command.chart import chart
from pneumo_ros.command.console import Console
from pneumo_ros.command.processes import Fleet
from pneumo_ros.errors import DataError, PneumoError

if TYPE_CHECKING:
    from pneumo_ros.records import Recording

LEVELS = (0.1, -0.05, 0.05, 0.0)  # m, references of the piston, one after the other
START = 60.0  # s, until the first valve command; the kernel may have to be compiled
# Sensors as on a rig: position alone, 5 um and 10 um steps; 300 Pa and 16 bit over 10 bar
SENSORS = {
    "publish_velocity": False,
    "noise_position": 5e-6,
    "quantisation_position": 1e-5,
    "noise_pressure": 300.0,
    "quantisation_pressure": 1e6 / 2**16,
    "seed": 1,
}
NAMESPACE = "demo"


def drive(bag: Path, logs: Path, seconds: float, console: Console) -> dict[str, int]:
    """Run the nodes for `seconds` of motion and end them; exit codes by name. PneumoError when one of them fails."""
    steps = {"reference.shape": "steps", "reference.levels": LEVELS, "reference.hold": seconds / len(LEVELS)}
    with Fleet(logs) as fleet:
        fleet.start("recorder", "pneumo_ros.ros.recorder", {"output": str(bag)}, NAMESPACE)
        fleet.start("simulator", "pneumo_ros.ros.simulator", SENSORS, NAMESPACE)
        fleet.start("controller", "pneumo_ros.ros.controller", steps, NAMESPACE)
        console.note("Starting the nodes")
        _wait_for_motion(fleet, bag)
        began = time.monotonic()
        with console.progress("Recording") as progress:
            while (passed := time.monotonic() - began) < seconds:
                progress(passed / seconds)
                fleet.wait(0.1)
        return fleet.stop()


def _wait_for_motion(fleet: Fleet, bag: Path) -> None:
    """Until the first valve command is in the bag; PneumoError after a minute."""
    from pneumo_ros.records import Bag

    for _ in range(round(START / 0.25)):
        fleet.wait(0.25)
        try:
            if Bag(bag).overview().counts.get(f"/{NAMESPACE}/valve/command"):
                return
        except DataError:  # nothing recorded yet
            continue
    raise PneumoError(f"no valve command within {START:g} s; the logs of the nodes are in {fleet.logs}")


def motion(recording: "Recording", seconds: float) -> str:
    """Chart of position and reference, and how near the piston came to each level."""
    import numpy as np

    assert recording.command_time is not None
    begin = float(recording.command_time[0])  # the controller counts from its first measurement
    hold = seconds / len(LEVELS)
    shown = (recording.time >= begin) & (recording.time < begin + seconds)
    passed, position = recording.time[shown] - begin, recording.position[shown]
    step = np.minimum(passed // hold, len(LEVELS) - 1).astype(int)
    drawing = chart(passed.tolist(), {"-": np.array(LEVELS)[step].tolist(), "*": position.tolist()}, "m")
    ends = [float(position[step == k][-1]) for k in range(len(LEVELS))]
    errors = ", ".join(f"{1e3 * abs(end - level):.2f}" for end, level in zip(ends, LEVELS, strict=True))
    return f"{drawing}\n\nDistance from the reference at the end of each step: {errors} mm"
