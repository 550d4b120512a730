"""Tracking before and after an effect that the machine file lacked was found in recordings and added."""

import numpy as np
from control_cases import AXIS, SINE, SINE_BEGIN, SINE_SECONDS, follow, shipped

from pneumo_ros.command.rated_motions import SAMPLE_TIME, stepper
from pneumo_ros.control.figures import Tracking, tracking
from pneumo_ros.control.reference import moves, sine
from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.diagnose.outcome import Outcome
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run

LOAD = 40.0  # N: 5 kg on an axis inclined by 55 degrees
HIDDEN = AXIS.with_effects([*AXIS.effects, "constant_load"], {"constant_load.load": LOAD})


def recordings() -> tuple[list[Run], list[Run]]:
    """Runs of the hidden machine to fit and to judge by: steps of the voltage, and motions under PID control."""
    seconds = 12.0
    fitted = [
        driven("steps", _steps([2.0, -2.0, 1.2, -1.2, 3.0, -3.0]), seconds),
        driven("slow", _steps([0.9, -1.0, 1.0, -0.9]), seconds),
        controlled("sine", 1),
    ]
    return fitted, [driven("held out", _steps([1.5, -1.5, 0.95, -2.5]), seconds), controlled("held out sine", 2)]


def _steps(levels: list[float]) -> np.ndarray:
    """Each of the voltages for a second, and none for half a second in between."""
    return np.concatenate([np.concatenate([np.full(1000, level), np.zeros(500)]) for level in levels])


def driven(name: str, volts: np.ndarray, seconds: float) -> Run:
    """An open-loop run of the hidden machine, sampled as a rig would."""
    plant, rows = stepper(HIDDEN), []
    held = np.resize(volts, round(seconds / SAMPLE_TIME))
    for volt in held:
        rows.append(plant.state.copy())
        plant.advance(float(volt))
    return _run(name, np.array(rows), held)


def controlled(name: str, seed: int) -> Run:
    """The hidden machine under PID control along a sine or moves."""
    reference = sine(0.2, 0.1) if seed == 1 else moves([0.0, 0.1, -0.1], 4.0, 1.5)
    record, _ = follow(HIDDEN, shipped("pid"), reference, 12.0, seed)
    return _run(name, record.states, record.voltage)


def _run(name: str, states: np.ndarray, held: np.ndarray) -> Run:
    noise = np.random.default_rng(len(name)).standard_normal((len(states), 3)) * [1e-5, 300.0, 300.0]
    y, p_a, p_b = (states[:, [0, 2, 3]] + noise).T
    return Run(name, SAMPLE_TIME, y, p_a, p_b, np.repeat(held[:-1], PARTS), np.ones(len(y), dtype=bool), False)


def found() -> Outcome:
    """The diagnosis of the recordings, starting from the default machine file."""
    return diagnose(AXIS, *recordings())


def tracked(known: Model) -> Tracking:
    """The cascade along the sine on the hidden machine, with a given machine file."""
    record, _ = follow(HIDDEN, shipped("cascade", known), SINE, SINE_SECONDS)
    return tracking(record, SINE_BEGIN)


def show() -> None:
    """Print the scenario."""
    outcome = found()
    added = [
        f"{a.effect} ({', '.join(f'{n} {v.value:.4g} {v.unit}' for n, v in a.parameters.items())})"
        for a in outcome.added
    ]
    print(f"\nAn axis that carries {LOAD:g} N the machine file does not know; verdict {outcome.verdict}")
    print(f"found and added: {', '.join(added) or 'nothing'}")
    print(f"{'cascade knows':26} {'rms [mm]':>9} {'peak [mm]':>10} {'breakaways':>11}")
    for name, known in (
        ("the machine file", AXIS),
        ("the one with what was found", outcome.model),
        ("the truth", HIDDEN),
    ):
        seen = tracked(known)
        print(f"{name:26} {1e3 * seen.rms:9.3f} {1e3 * seen.peak:10.2f} {seen.breakaways:11d}")
