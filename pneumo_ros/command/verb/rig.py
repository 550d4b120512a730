"""How a rig is wired: guess it from a recording, show why, and write it as a file that --rig takes.

pneumo rig check BAG --model my.yaml --out rig.yaml

Units, gauge or absolute, swapped chambers, reversed position or command, the zero of the encoder and the signal that
closes the valve are tried in every combination; the machine's equations say which one it is. Where two explain the
recording alike, such as mirror images, the machine is fitted to it with both, within what its file says. Exit code 1
when even that does not tell them apart.
"""

import argparse
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import add_model, add_output, chosen_model
from pneumo_ros.command.console import Console, columns
from pneumo_ros.command.rig_file import rig_text
from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable, write_whole

if TYPE_CHECKING:
    from pneumo_ros.plant import Model
    from pneumo_ros.reading.rig_guess import Guess, Hypothesis

EXAMPLES = (
    "pneumo rig check runs/strokes --model my.yaml --out rig.yaml",
    "pneumo rig check runs/strokes --model my.yaml      # then: pneumo compare runs/strokes --rig rig.yaml",
)  # parsed by a test
SHOWN = 5  # hypotheses


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """check BAG, the machine, where to write, and the common options."""
    parser.add_argument("what", choices=("check",), help="guess the wiring from a recording")
    parser.add_argument("bag", metavar="BAG", help="a recording in which the piston moves both ways")
    parser.add_argument("--namespace", metavar="NS", help="of the axis, where a recording holds several")
    parser.add_argument("--joint", metavar="NAME", help="the piston in joint_states, where these hold several joints")
    parser.add_argument("--out", metavar="RIG.yaml", help="write the wiring; --rig of other verbs takes it")
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Read, guess, print, write."""
    from pneumo_ros.commission.wiring import fitted
    from pneumo_ros.reading.rig_guess import guess_rig
    from pneumo_ros.records import read_recording

    if options.out and check_writable(options.out).exists():
        raise UsageError(f"{options.out} exists and is not overwritten; name another file")
    model = chosen_model(options)
    recording = read_recording(options.bag, options.namespace, options.joint)
    with console.progress("Trying"):
        found = fitted(guess_rig(recording, model), [recording], model)
    console.say(text(found, recording.name, model.name))
    if options.out:
        origin = f"From {Path(options.bag).name}: check each line."
        words, joint = found.best.words, recording.joint_name
        content = rig_text(options.model, options.namespace or "", joint, words, origin, model, _closed(words, model))
        write_whole(options.out, content)
        console.note(f"Written to {options.out}")
        console.next(f"compare {shlex.quote(options.bag)} --rig {shlex.quote(options.out)}")
    elif found.best.words:
        how = f"--model {shlex.quote(options.model)} --read-as {','.join(found.best.words)}"
        console.next(f"compare {shlex.quote(options.bag)} {how}")
    console.json(as_dict(found))
    return 0 if found.certain else 1


def _closed(words: tuple[str, ...], model: "Model") -> float | None:
    """The signal [V] that closes the valve, where the recording or the machine file shows it."""
    from pneumo_ros.plant.closed import closed_signal, says_closed
    from pneumo_ros.records.corrections import wiring

    shown = says_closed(model.effects, model.parameters, model.uncertainty) or any(
        word.startswith("closed=") for word in words
    )
    return wiring(words).command(closed_signal(model)) if shown else None


def text(found: "Guess", recording: str, machine: str) -> str:
    """The likeliest hypotheses with their residuals, and a sentence."""
    names = list(found.best.residuals)
    rows = [("as", *(f"{name.replace('_', ' ')}" for name in names), "times the best")]
    for one in found.ranked[:SHOWN]:
        rows.append((_words(one), *(f"{one.residuals[n]:.3g}" for n in names), f"{one.size / found.best.size:.2f}"))
    said = f"{recording} was recorded as: {_words(found.best)}."
    if not found.best.words:
        said = f"{recording} is as '{machine}' needs it: SI units, absolute pressures, nothing swapped or reversed."
    if found.recorded is not None and found.best.words:
        said += f" Taken as it is, its residuals are {found.recorded.size / found.best.size:.1f} times as large."
    if not found.certain:
        apart = ",".join(sorted({*found.best.words} ^ {*found.alike[1].words}))
        said += f" The next one explains it nearly as well. They differ in {apart}."
    return columns(rows, right=range(1, len(rows[0]))) + "\n\n" + said


def _words(one: "Hypothesis") -> str:
    return ",".join(one.words) or "it is"


def as_dict(found: "Guess") -> dict[str, Any]:
    """JSON: the words, whether they are certain, and the likeliest hypotheses."""
    return {
        "schema_version": 1, "read_as": list(found.best.words), "certain": found.certain,
        "hypotheses": [
            {"read_as": list(one.words), "residuals": one.residuals, "times_best": one.size / found.best.size}
            for one in found.ranked[:SHOWN]
        ],
    }  # fmt: skip
