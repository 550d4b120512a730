"""One machine of the comparison with other methods: it is recorded, and each method says what the model lacks."""

import hashlib
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import peer_shooting
from blind_case import build_case, code_hash, drawn_excitation, drawn_strength, recorded

from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.plant import load_model

Namer = Callable[[Sequence[Any], Sequence[Any]], list[str]]  # training and held-out runs -> effects, the first first
OWN_FILES = {  # what a method's results depend on, besides the package and the rig
    "diagnosis": (),
    "pysindy": ("peer_sindy.py", "peer_weak.py", "peer_signals.py", "peer_terms.py"),
    "shooting": ("peer_shooting.py",),
}


def namers(segments: int) -> dict[str, Namer]:
    """The methods by name."""
    return {
        "diagnosis": by_diagnosis,
        "pysindy": by_pysindy,
        "shooting": lambda train, held: peer_shooting.named(load_model("axis"), train, segments),
    }


def by_diagnosis(train: Sequence[Any], held: Sequence[Any]) -> list[str]:
    """What `diagnose` adds, in its order."""
    return [added.effect for added in diagnose(load_model("axis"), train, held).added]


def by_pysindy(train: Sequence[Any], held: Sequence[Any]) -> list[str]:
    """What PySINDy selects; its module is imported here, because it may be missing."""
    import peer_sindy

    return peer_sindy.named(load_model("axis"), [*train, *held])


def method_code(method: str, segments: int) -> str:
    """Identifies the code and the options that the results of a method depend on."""
    digest = hashlib.sha256(code_hash().encode())
    for name in OWN_FILES[method]:
        digest.update(Path(__file__).with_name(name).read_bytes())
    digest.update(f"{segments}".encode() if method == "shooting" else b"")
    return digest.hexdigest()[:12]


def judged(kind: str, seed: int, methods: Sequence[str], segments: int) -> Iterator[dict[str, Any]]:
    """Record one machine, and yield the result of each method."""
    strength, excitation = drawn_strength(kind, seed), drawn_excitation(kind, seed)
    case = build_case(kind, seed, strength)
    train, held = recorded(case, excitation)
    machine = {"kind": kind, "seed": seed, "strength": strength, "excitation": excitation}
    machine["hidden"] = [hidden["shape"] for hidden in case.truth["effects"]]
    for method in methods:
        wall, processor = time.perf_counter(), time.process_time()
        names = namers(segments)[method](train, held)
        cost = {"wall": time.perf_counter() - wall, "processor": time.process_time() - processor}
        yield {**machine, "method": method, "code": method_code(method, segments), "named": names, **cost}
