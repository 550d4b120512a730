"""Short recordings of rig machines."""

from dataclasses import replace
from pathlib import Path

from rig import bags, case, effects

from pneumo_ros.records import read_recording
from pneumo_ros.runs.run import PARTS, Run, make_run

STEP = 4e-5  # s, of the rig
SAMPLES = 12_000  # of each run
TRAIN, HELD = ("train_steps", "train_slow"), ("holdout_steps",)


def recordings_of(folder: Path, seed: int, *hidden: str) -> tuple[list[Run], list[Run]]:
    """Runs of the worn machine of `seed` that hides these effects, to fit and held out."""
    machine = effects.build(seed, [effects.parse(text) for text in hidden])
    runs = {}
    for run in case.make_runs(machine, (*TRAIN, *HELD), STEP):
        bags.write(folder / run.name, run, case.epoch(seed))
        runs[run.name] = shortened(make_run(read_recording(folder / run.name)))
    return [runs[name] for name in TRAIN], [runs[name] for name in HELD]


def shortened(run: Run) -> Run:
    """The first seconds of a run."""
    n = SAMPLES
    assert run.pressure_a is not None
    assert run.pressure_b is not None
    return replace(
        run, position=run.position[:n], pressure_a=run.pressure_a[:n], pressure_b=run.pressure_b[:n],
        input=run.input[: (n - 1) * PARTS], measured=run.measured[:n],
    )  # fmt: skip
