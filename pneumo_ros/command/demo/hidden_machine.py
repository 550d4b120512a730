"""Recordings of a machine that hides an effect drawn by a seed: from a second simulator, or the package's own plant."""

import json
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import Console
from pneumo_ros.errors import PneumoError

if TYPE_CHECKING:
    from random import Random

    from pneumo_ros.plant import Model

# Effects the plant may hide, each with the parameter that sets its size, and its range. End cushions are left out,
# and effects that only long rests or long runs show.
HIDEABLE = {
    "viscous_friction": ("coefficient", 80.0, 300.0),
    "asymmetric_friction": ("ratio", 0.1, 0.4),
    "asymmetric_viscous_friction": ("coefficient_retraction", 60.0, 150.0),
    "pressure_dependent_friction": ("coefficient", 3e-5, 1e-4),
    "payload_mass": ("mass_added", 3.0, 20.0),
    "constant_load": ("load", 15.0, 50.0),
    "spring_load": ("stiffness", 40.0, 150.0),
    "valve_spool_dynamics": ("angular_frequency", 50.0, 110.0),
    "valve_null_offset": ("offset", 0.05, 0.3),
    "valve_hysteresis": ("half_width", 0.05, 0.2),
    "supply_pressure_droop": ("resistance_supply", 4e7, 1.7e8),
    "cross_piston_leakage": ("conductance", 1e-10, 1e-9),
    "pressure_sensor_gain": ("error_a", 0.01, 0.03),
    "position_sensor_delay": ("delay", 4e-3, 2e-2),
}
WEAR = 0.05  # share by which parameters of friction, dead zone and flow are off
WORN = ("lugre_friction", "quadratic_drag", "dead_zone", "arctan_flow")
EXACT = ("lugre_friction.breakaway_ratio", "dead_zone.right_slope", "dead_zone.left_slope")
EXPERIMENTS = ("steps", "sweep", "slow-reversals")
SAMPLE = 1e-3  # s
POSITION_NOISE, POSITION_STEP, PRESSURE_NOISE, PRESSURE_STEP = 5e-6, 1e-5, 300.0, 1e6 / 2**16  # m, Pa


def second_simulator() -> Path | None:
    """The folder of the simulator that shares no code with the package, if this runs from a checkout."""
    folder = Path(__file__).parents[3] / "test" / "rig"
    return folder if (folder / "__main__.py").is_file() else None


def record_machine(folder: Path, truth: Path, seed: int, rig: Path | None, console: Console) -> None:
    """Record the machine of `seed` into `folder`/train and `folder`/holdout, its hidden effect into file `truth`.

    `rig` is the folder of a second simulator; None takes the package's plant. PneumoError when the simulator fails.
    """
    console.note("Recording the machine")
    made = folder / "made"
    if rig is None:
        _record_plant(made, truth, seed)
    else:
        _record_rig(made, truth, seed, rig)
    for part in ("train", "holdout"):
        (folder / part).mkdir()
        for run in sorted(made.glob(f"{part}_*")):
            run.rename(folder / part / run.name)
    made.rmdir()


def _record_rig(folder: Path, truth: Path, seed: int, rig: Path) -> None:
    wanted = ["--effect", "random", "--seed", str(seed), "--runs", "train_*", "holdout_*", "--quiet"]
    command = [sys.executable, str(rig), "--out", str(folder), "--truth", str(truth), *wanted]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        last = (done.stderr.strip() or f"exit code {done.returncode}").splitlines()[-1]
        raise PneumoError(f"the simulator in {rig} failed: {last}")


def _record_plant(folder: Path, truth: Path, seed: int) -> None:
    from random import Random

    random = Random(seed)
    machine, hidden = hiding_model(random)
    folder.mkdir()
    for experiment in EXPERIMENTS:
        _perform(folder, experiment, machine, seed)
    truth.write_text(json.dumps({"seed": seed, "effects": [hidden]}, indent=2) + "\n", encoding="utf-8")


def hiding_model(random: "Random") -> "tuple[Model, dict[str, Any]]":
    """A worn machine with one effect more than the default one, and the truth about that effect."""
    from pneumo_ros.plant import load_model

    model = load_model()
    worn = [n for n in model.parameters if n.partition(".")[0] in WORN and n not in EXACT]
    model = model.with_parameters({name: model[name] * random.uniform(1.0 - WEAR, 1.0 + WEAR) for name in worn})
    effect = random.choice(sorted(HIDEABLE))
    key, low, high = HIDEABLE[effect]
    size = low * (high / low) ** random.random()
    hiding = model.with_effects([*model.effects, effect], {f"{effect}.{key}": size})
    unit = hiding.specification(f"{effect}.{key}").unit
    return hiding, {"effect": effect, "shape": effect, "size": size, "unit": unit}


def _perform(folder: Path, experiment: str, machine: "Model", seed: int) -> None:
    """Conduct an experiment on the machine, and write its trials as sensors show them."""
    import numpy as np

    from pneumo_ros.experiment.catalogue import make_programme
    from pneumo_ros.experiment.rehearsal import rehearse
    from pneumo_ros.plant import load_model
    from pneumo_ros.records.writing import write_recording

    programme = make_programme(experiment, load_model())  # without knowledge of the hidden effect
    rehearsal = rehearse(programme, machine)
    time = SAMPLE * np.arange(round(rehearsal.duration / SAMPLE) + 1)
    when, volts = np.array(rehearsal.commands).T
    voltage = volts[np.searchsorted(when, time + 0.5 * SAMPLE, side="right") - 1]
    states = np.vstack([machine.state(), machine.simulate(voltage[:-1], machine.state(), sample_time=SAMPLE)])
    seen = machine.outputs(states, np.concatenate([voltage[:1], voltage[:-1]]), start=-SAMPLE)
    noise = np.random.default_rng([seed, EXPERIMENTS.index(experiment)])
    for trial, (begin, end) in zip(programme.trials, rehearsal.recorded, strict=True):
        part = slice(round(begin / SAMPLE), round(end / SAMPLE) + 1)

        def shown(name: str, spread: float, step: float, part: slice = part) -> "np.ndarray[Any, Any]":
            signal = seen[name][part]
            return np.round((signal + noise.normal(0.0, spread, len(signal))) / step) * step

        write_recording(
            folder / trial.name,
            time=time[part] - time[part][0],
            position=shown("y_measured", POSITION_NOISE, POSITION_STEP),
            pressure_a=shown("p_a_measured", PRESSURE_NOISE, PRESSURE_STEP),
            pressure_b=shown("p_b_measured", PRESSURE_NOISE, PRESSURE_STEP),
            voltage=voltage[part],
        )
