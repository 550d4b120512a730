"""Record a machine that hides an effect, diagnose it, and reveal the truth, which is read only at the end."""

import json
import shlex
import subprocess
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from pneumo_ros.command.console import Console, program
from pneumo_ros.command.demo.hidden_machine import record_machine
from pneumo_ros.command.demo.revealing import judge
from pneumo_ros.errors import PneumoError

INTERRUPTED = 130
OTHER = "the simulator in {rig}, which shares no code with this package"
DEFINED = " (as that simulator defines its sizes: of a play it states half the width)"
OWN = """this package's own plant, as there is no other simulator here: except for the hidden effect, its equations are
those of the model, which is easier than a real machine"""


def find_effect(folder: Path, seed: int, rig: Path | None, console: Console) -> dict[str, Any]:
    """Record into `folder` a machine that hides an effect, compare, diagnose, reveal; returns what was said as JSON.

    `rig` is the folder of a second simulator, or None. PneumoError when it or one of the verbs fails.
    """
    machine, truth, found = folder / "machine", folder / "truth.json", folder / "diagnosis.json"
    console.say(
        f"\n4. Another machine is recorded; it is worn, and hides an effect. Seed {seed} (repeat: --seed {seed})\n"
    )
    machine.mkdir()
    record_machine(machine, truth, seed, rig, console)
    console.say(f"Simulated by {OTHER.format(rig=rig) if rig else OWN}.")
    console.say("\n5. Where does the model fail?\n")
    _call(["compare", next((machine / "holdout").glob("holdout_steps*"))], console)
    console.say("\n6. What does the model lack? Fitted to the runs in train, judged by those in holdout\n")
    written = {"--out": folder / "improved.yaml", "--report": folder / "report.html", "--json": found}
    options = [word for pair in written.items() for word in pair]
    _call(["diagnose", machine / "train", "--holdout", machine / "holdout", *options], console, written.values())
    console.say("\n7. The truth, read only now\n")
    return _reveal(
        json.loads(truth.read_text(encoding="utf-8")), json.loads(found.read_text(encoding="utf-8")), rig, console
    )


def _call(arguments: Sequence[str | Path], console: Console, written: Iterable[Path] = ()) -> None:
    """Run a verb as a user does, and print its command line; PneumoError when it fails or does not write its files."""
    words = [str(word) for word in arguments]
    console.say(f"$ {program()} {shlex.join(words)}")
    silent = subprocess.DEVNULL if console.json_target == "-" else None
    quiet = ["--quiet"] if console.quiet else []
    with subprocess.Popen([sys.executable, "-m", "pneumo_ros", *words, *quiet], stdout=silent) as process:
        try:
            code = process.wait()
        except KeyboardInterrupt:
            process.wait()  # it was interrupted too, and may still write results
            raise
    if code == INTERRUPTED:
        raise KeyboardInterrupt
    if code not in (0, 1) or not all(path.exists() for path in written):  # Python's own failures end with 1 too
        raise PneumoError(f"{program()} {words[0]} ended with exit code {code}")


def _reveal(truth: dict[str, Any], diagnosis: dict[str, Any], rig: Path | None, console: Console) -> dict[str, Any]:
    """Say what was hidden, what was found, and whether that is right."""
    hidden, added = truth["effects"], diagnosis["added"]
    judgement = judge([h["effect"] for h in hidden], [(a["effect"], a["indistinguishable_from"]) for a in added])
    sizes = ", ".join(f"{h['shape']}, {h['size']:.4g} {h['unit']}" for h in hidden)
    console.say(f"Hidden: {sizes}{DEFINED if rig else ''}")
    console.say("Found:  " + (", ".join(_found(addition) for addition in added) or "nothing"))
    console.say(f"\n{judgement.sentence()}")
    return {
        "hidden": [{key: h[key] for key in ("effect", "shape", "size", "unit")} for h in hidden],
        "added": added,
        "right": judgement.right,
        "judgement": judgement.word,
    }


def _found(addition: dict[str, Any]) -> str:
    effect, rivals = str(addition["effect"]), addition["indistinguishable_from"]
    values = [(key, p) for key, p in addition["parameters"].items() if p["std"] is not None]  # None: not determined
    shown = ", ".join(f"{key} {p['value']:.4g} +- {1.96 * p['std']:.2g} {p['unit']}" for key, p in values[:4])
    return effect + (f" ({shown})" if shown else "") + (f", or {' or '.join(rivals)}" if rivals else "")
