"""One machine of the independent rig, diagnosed as recorded or after one change that must not change the answer.

    python benchmarks/invariance_case.py SEED CHANGE

prints one line of JSON. Parameters of added effects are those of the machine as recorded, whatever was changed.
"""

import hashlib
import json
import sys
import time
from pathlib import Path
from typing import Any

import blind_case
from invariance_changes import AS_RECORDED, LARGER, OF_QUESTIONS, OF_RECORDINGS, Question
from invariance_machines import factor, mirrored_name, mirrored_value

from pneumo_ros.plant import load_model
from pneumo_ros.plant.library import Library

HEALTHY = 5  # of so many machines one hides nothing
TIMED = ("friction_warmup",)  # counts from the start of a recording: of a second piece the model is another
Deviating = tuple[float, float | None]  # value and its standard deviation


def code_hash() -> str:
    """Identifies the code that results depend on."""
    digest = hashlib.sha256(blind_case.code_hash().encode())
    for path in sorted(Path(__file__).parent.glob("invariance_[cm]*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def kind_of(seed: int) -> str:
    """What the machine of a seed hides."""
    return "healthy" if seed % HEALTHY == HEALTHY - 1 else "single"


def applies(seed: int, change: str) -> bool:
    """Whether a change leaves the answer for the machine of that seed as it is."""
    hidden = blind_case.drawn_shape(seed, 6).partition(":")[0] if kind_of(seed) == "single" else ""
    return change != "pieces" or hidden not in TIMED


def asked(case: Any, excitation: str, change: str) -> Question:
    """The question after a change."""
    from rig.case import runs_for

    names, model = runs_for(case, excitation), load_model("axis")
    if change in OF_RECORDINGS:
        return Question(model, *OF_RECORDINGS[change](case, names))
    question = Question(model, *blind_case.recorded(case, excitation))
    return question if change == AS_RECORDED else OF_QUESTIONS[change](question)


def as_recorded(effect: str, parameters: dict[str, Deviating], change: str) -> dict[str, Deviating]:
    """Parameters of an added effect, told for the machine as recorded."""
    back = {}
    for key, (value, std) in parameters.items():
        dotted = f"{effect}.{key}"
        if change == "mirrored":
            key, value = mirrored_name(dotted).partition(".")[2], mirrored_value(dotted, value)
        by = factor(Library().find(effect).parameters[key].unit, *LARGER.get(change, (1.0, 1.0)))
        back[key] = value / by, None if std is None else std / by
    return back


def diagnosed(seed: int, change: str) -> dict[str, Any]:
    """Record, change and diagnose one machine."""
    from pneumo_ros.diagnose.diagnosis import diagnose

    kind = kind_of(seed)
    strength, excitation = blind_case.drawn_strength(kind, seed), blind_case.drawn_excitation(kind, seed)
    case = blind_case.build_case(kind, seed, strength)
    question, begun = asked(case, excitation, change), time.perf_counter()
    found = blind_case.found(outcome := diagnose(*question))
    if outcome.interrupted:
        raise KeyboardInterrupt
    for added in found["added"]:
        added["parameters"] = as_recorded(added["effect"], added["parameters"], change)
    return {
        "code": code_hash(), "seed": seed, "change": change, "kind": kind, "strength": strength,
        "excitation": excitation, "hidden": [hidden["shape"] for hidden in case.truth["effects"]],
        **found, "wall": time.perf_counter() - begun,
    }  # fmt: skip


if __name__ == "__main__":
    print(json.dumps(diagnosed(int(sys.argv[1]), sys.argv[2])))
