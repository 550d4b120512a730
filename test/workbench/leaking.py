"""Short recordings of a rig machine whose piston leaks, so that a refit takes seconds."""

from pathlib import Path
from typing import Any

from rig import bags, case, effects

LEAK = "cross_piston_leakage"
SECONDS = 6.0
STEP = 4e-5  # s, of the rig
SEED = 5


def record_leaking(folder: Path, names: tuple[str, ...] = ("train_steps", "holdout_steps")) -> None:
    """Write the first seconds of these runs into `folder`."""
    machine = effects.build(SEED, [effects.parse(f"{LEAK}=3e-10")])
    for run in case.make_runs(machine, names, STEP):
        bags.write(folder / run.name, first(run), case.epoch(SEED))


def first(run: Any) -> Any:
    """The beginning of a run."""
    n = round(SECONDS * 1000)
    names = ("stamps", "log_times", "position", "pressure_a", "pressure_b", "voltage", "truth")
    cut = {name: getattr(run, name)[:n] for name in names}
    return run._replace(command_index=run.command_index[run.command_index < n], **cut)
