"""One case of the blind benchmark: a machine of the independent rig is recorded and diagnosed.

    python benchmarks/blind_case.py KIND SEED STRENGTH [EXCITATION]

prints one line of JSON: the truth, the result, the cost. Each case has its own process, and so its own peak of
memory. EXCITATION is one of `rig.excitation.EXCITATIONS`; without it, the rig's usual recordings.
"""

import hashlib
import json
import resource
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from blind_parameters import true_parameters

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "test"))  # the rig imports as `rig`

STEP = 4e-5  # s, of the rig; twice that of its command line
DECIDING = ("size", "share", "first", "known", "pays", "contained", "lag", "swing", "refused")  # of a candidate
WEAKEST = 0.2  # share of full strength
RANKED = 5  # candidates kept
KINDS = ("single", "pair", "healthy", "outside", "rough", "rough_healthy", "triple")
PARTNER = {
    "single": "healthy",
    "pair": "healthy",
    "triple": "healthy",
    "rough": "rough_healthy",
}  # the same machine with nothing hidden
SEVERAL = {"pair": 2, "triple": 3}  # kinds that hide several effects
# Rooms of the package that a result depends on: `diagnose` and all that it imports
JUDGED = ("plant", "records", "runs", "equations", "shooting", "identify", "compare", "diagnose")


def code_hash() -> str:
    """Identifies the code that results depend on: the package without its commands and nodes, the rig, the cases."""
    folders = [*(ROOT / "pneumo_ros" / part for part in JUDGED), ROOT / "pneumo_ros" / "config", ROOT / "test" / "rig"]
    files = [path for folder in folders for path in folder.rglob("*") if path.suffix in (".py", ".yaml")]
    digest = hashlib.sha256()
    for path in [*sorted(files), Path(__file__), Path(__file__).with_name("blind_parameters.py")]:
        digest.update(str(path.relative_to(ROOT)).encode() + path.read_bytes())
    return digest.hexdigest()[:12]


def drawn_strength(kind: str, seed: int) -> float:
    """Share of full strength, uniform from a fifth; 1 where nothing is hidden."""
    if kind in PARTNER.values():
        return 1.0
    return round(float(np.random.default_rng([seed, KINDS.index(kind), 4]).uniform(WEAKEST, 1.0)), 3)


def drawn_shape(seed: int, salt: int) -> str:
    """Every catalogue name once in as many seeds, in random order and with a random shape."""
    from rig.effects import EFFECTS, OUTSIDE

    shapes: dict[str, list[str]] = {}
    for name in EFFECTS:
        if name not in OUTSIDE:
            shapes.setdefault(name.partition(":")[0], []).append(name)
    turn, place = divmod(seed, len(shapes))
    name = list(shapes)[np.random.default_rng([turn, salt]).permutation(len(shapes))[place]]
    return str(np.random.default_rng([seed, salt]).choice(shapes[name]))


def build_case(kind: str, seed: int, strength: float) -> Any:
    """The rig's case; KeyError for an unknown kind."""
    from rig import effects

    if kind in SEVERAL:
        return effects.draw(seed, SEVERAL[kind], (strength, strength))
    wishes = {
        "single": lambda: [effects.Wish(drawn_shape(seed, 6))],
        "rough": lambda: [effects.Wish(drawn_shape(seed, 7))],
        "outside": lambda: [effects.Wish(list(effects.OUTSIDE)[seed % len(effects.OUTSIDE)])],
        "healthy": list,
        "rough_healthy": list,
    }[kind]()
    return effects.build(seed, wishes, rough=kind.startswith("rough"), scale=strength)


def drawn_excitation(kind: str, seed: int) -> str:
    """A kind of excitation other than the usual one; the same for a machine and for its healthy partner."""
    from rig.excitation import EXCITATIONS

    others = [name for name in EXCITATIONS if name != "usual"]
    salt = KINDS.index(PARTNER.get(kind, kind))
    return str(np.random.default_rng([seed, salt, 8]).choice(others))


def recorded(case: Any, excitation: str) -> tuple[list[Any], list[Any]]:
    """The training and the held-out runs of a case, written as bags and read again."""
    from rig.case import runs_for

    return divided(taken(case, runs_for(case, excitation)))


def taken(case: Any, names: Sequence[str], **logger: float) -> dict[str, Any]:
    """The named runs of a case, written as bags and read again; `logger` as in `rig.sensors.Logger`."""
    from rig import bags
    from rig import case as rig_case
    from rig.sensors import Logger

    from pneumo_ros.records import read_recording
    from pneumo_ros.runs.run import make_run

    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for run in rig_case.make_runs(case, names, STEP, Logger(**logger)):
            path = Path(folder) / run.name
            bags.write(path, run, rig_case.epoch(case.seed))
            found[run.name] = make_run(read_recording(path))
    return found


def divided(runs: Mapping[str, Any]) -> tuple[list[Any], list[Any]]:
    """All runs of a case, those to fit and those that are held out."""
    from rig.excitation import held_out

    held = [name for name in runs if held_out(name, tuple(runs))]
    return [run for name, run in runs.items() if name not in held], [runs[name] for name in held]


def found(outcome: Any) -> dict[str, Any]:
    """The part of an outcome that is kept."""
    left, last = outcome.unexplained, outcome.steps[-1] if outcome.steps else None
    return {
        "verdict": outcome.verdict,
        "failing": outcome.failing,
        "added": [
            {
                "effect": a.effect,
                "group": a.indistinguishable_from,
                "t": a.t,
                "parameters": {k: (p.value, p.std if np.isfinite(p.std) else None) for k, p in a.parameters.items()},
            }
            for a in outcome.added
        ],
        "ranking": [(r.effect, r.score.nats, r.holdout_gain, r.objections) for r in outcome.ranking[:RANKED]],
        "cannot_say": [*({**last.unseen, **last.undecided} if last else ())],
        "decisions": [decision(step) for step in outcome.steps],
        "course": outcome.waterfall,
        "unexplained": left and {"equation": left.equation, "against": left.against, "rms": left.rms},
    }


def decision(step: Any) -> list[dict[str, Any]]:
    """What was decided about each candidate of a round, best first: all numbers that a decision asks for."""
    return [
        {
            "effect": c.name,
            "train": c.score.train,
            "heldout": c.score.held,
            **{key: getattr(c, key) for key in DECIDING},
        }
        for c in step.candidates
    ]


def diagnosed(kind: str, seed: int, strength: float, excitation: str = "usual") -> dict[str, Any]:
    """Record and diagnose one case."""
    from pneumo_ros.diagnose.diagnosis import diagnose
    from pneumo_ros.plant import load_model

    result: dict[str, Any] = {"code": code_hash(), "kind": kind, "seed": seed, "strength": strength}
    result["excitation"] = excitation
    case = build_case(kind, seed, strength)
    train, held = recorded(case, excitation)
    wall, processor = time.perf_counter(), time.process_time()
    outcome = diagnose(load_model("axis"), train, held)
    if outcome.interrupted:
        raise KeyboardInterrupt
    cost = {"wall": time.perf_counter() - wall, "processor": time.process_time() - processor}
    hidden = [{k: v for k, v in effect.items() if k != "fields"} for effect in case.truth["effects"]]
    return {
        **result,
        "hidden": hidden,
        "true_parameters": true_parameters(case.truth),
        **found(outcome),
        **cost,
        "recorded": sum(float(run.time[-1]) for run in (*train, *held)),
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
    }


if __name__ == "__main__":
    print(json.dumps(diagnosed(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), *sys.argv[4:5])))
