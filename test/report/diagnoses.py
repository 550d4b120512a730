"""Diagnoses to report: real searches in a short catalogue, of the model's own runs with sensor noise."""

from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from identify import making
from identify.making import POSITION_NOISE, PRESSURE_NOISE, QUANTUM, voltage
from kept import kept

from pneumo_ros.command.console import plain
from pneumo_ros.command.diagnosis_json import diagnosis_dict
from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.diagnose.outcome import Outcome
from pneumo_ros.plant import Model, load_model
from pneumo_ros.plant.library import Library
from pneumo_ros.report.chart import Report
from pneumo_ros.report.diagnosis import diagnosis_report
from pneumo_ros.report.provenance import provenance
from pneumo_ros.runs.run import PARTS, Run

HOSTILE = """<img src=x onerror="window.hacked=1">'"&</script><script>window.hacked=2</script>"""
COMMAND = ["diagnose", "sweep", "steps", "--holdout", "held out", "--report", "found.html"]
EXPERIMENT = "Creep over the whole stroke & back <slowly>."
COEFFICIENT = 60.0  # N s/m of the friction that the model lacks
HIDDEN = {"adequate": (), "effects_found": ("viscous_friction",), "unknown_effect": ("constant_load",)}
HIDDEN_SIZES = {
    "adequate": {},
    "effects_found": {"viscous_friction.coefficient": COEFFICIENT},
    "unknown_effect": {"constant_load.load": 15.0},
}
KNOWN = {"effects_found": ("viscous_friction", "constant_load")}  # verdict -> effects that the search knows of


class Few(Library):
    """A catalogue of a few effects: fewer to compile and to try."""

    def __init__(self, candidates: tuple[str, ...]) -> None:
        super().__init__()
        self.candidates = candidates

    def names(self) -> list[str]:
        """Only the candidates; effects of the machine are still found by name."""
        return list(self.candidates)


@lru_cache(maxsize=3)
def diagnosed(verdict: str) -> Outcome:
    """The outcome with this verdict, computed once by the code as it is."""
    outcome: Outcome = kept(verdict, lambda: diagnose_anew(verdict), Path(__file__), Path(making.__file__))
    return outcome


def diagnose_anew(verdict: str) -> Outcome:
    """A machine with viscous friction that the model lacks; with a load that no catalogue has; or with neither."""
    base = load_model()
    given = Model(base.composition, base.parameters, base.name, Few(KNOWN.get(verdict, ("viscous_friction",))))
    truth = base.with_effects([*base.effects, *HIDDEN[verdict]], HIDDEN_SIZES[verdict])
    train = [recorded(truth, kind, kind, seed) for seed, kind in enumerate(("sweep", "steps"))]
    return diagnose(given, train, [recorded(truth, "steps", HOSTILE, 7, seconds=15.0)])


def recorded(truth: Model, kind: str, name: str, seed: int, seconds: float = 6.0) -> Run:
    """The sensor signals of a machine moved by `identify.making.voltage`."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(seconds * 1000)) * 1e-3
    held = np.repeat(voltage(kind, time + seed)[:-1], PARTS)
    start = truth.state(p_a=3e5, p_b=3.9e5)
    states = np.vstack([start, truth.simulate(held, start, sample_time=1e-3, parts=PARTS)])
    y, p_a, p_b = states[:, [0, 2, 3]].T
    y = np.round((y + rng.normal(0.0, POSITION_NOISE, len(time))) / QUANTUM) * QUANTUM
    p_a, p_b = (p + rng.normal(0.0, PRESSURE_NOISE, len(time)) for p in (p_a, p_b))
    return Run(name, 1e-3, y, p_a, p_b, held, np.ones(len(time), dtype=bool), False)


def diagnosis_of(outcome: Outcome, result: dict[str, Any] | None = None) -> Report:
    """The report of a diagnosis; `result` is its JSON."""
    compared = plain(outcome.after.as_dict())
    return diagnosis_report(outcome, result or json_of(outcome), compared, provenance([], "axis", COMMAND))


def json_of(outcome: Outcome) -> dict[str, Any]:
    """The JSON of a diagnosis."""
    result: dict[str, Any] = plain(diagnosis_dict(outcome, {}, EXPERIMENT))
    return result
