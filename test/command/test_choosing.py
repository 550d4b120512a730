"""--namespace and --joint: every verb that reads recordings uses the chosen axis, and asks when the choice is open."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from identify.constant import constant_run, write_bag
from records.making import STORE, serialized

from pneumo_ros.command.main import main
from pneumo_ros.records import Bag, BagTopic, BagWriter
from pneumo_ros.records.contract import JOINT_STATES, TYPES

VOLTAGES = (0.83, 1.0, 7.0)  # of the left axis; the right one is driven the other way
SIDES = {"left": 1.0, "right": -1.0}
VERBS = {
    "compare": ["compare", "{bags}/run_1", "--model", "paper"],
    "identify": ["identify", "{bags}", "--model", "paper", "--out", "{out}"],
    "simulate": ["simulate", "--input", "{bags}/run_1", "--model", "paper", "--seconds", "1", "--out", "{out}"],
}
Content = list[tuple[str, int, bytes]]  # contract name, recorded time [ns], message


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The runs of each axis alone, of both in one recording, and of a rod and a hand in one joint state."""
    folder = tmp_path_factory.mktemp("choosing")
    for part in (*SIDES, "axes", "joints"):
        (folder / part).mkdir()
    for number, volts in enumerate(VOLTAGES):
        content = {}
        for side, sign in SIDES.items():
            alone = write_bag(folder / side / f"run_{number}", constant_run(sign * volts))
            content[side] = [(m.channel.topic.strip("/"), m.log_time, m.payload) for m in Bag(alone).messages()]
        merge(folder / "axes" / f"run_{number}", content)
        merge(folder / "joints" / f"run_{number}", {"": with_hand(content["right"])})
    return folder


def merge(path: Path, content: dict[str, Content]) -> None:
    """A recording of several axes, by namespace."""
    rows = [(at, space, name, data) for space, messages in content.items() for name, at, data in messages]
    topics = {(space, name): f"/{space}/{name}".replace("//", "/") for _, space, name, _ in rows}
    with BagWriter(path, [BagTopic(topic, TYPES[name]) for (_, name), topic in topics.items()]) as writer:
        for at, space, name, data in sorted(rows, key=lambda row: row[0]):
            writer.write(topics[space, name], at, data)


def with_hand(rows: Content) -> Content:
    """The same, with joint states of a hand, which moves differently, and of the piston as `rod`."""
    return [(name, at, two_joints(data) if name == JOINT_STATES else data) for name, at, data in rows]


def two_joints(data: bytes) -> bytes:
    kind = TYPES[JOINT_STATES]
    message: Any = STORE.deserialize_cdr(data, kind)
    position, empty = float(message.position[0]), np.empty(0)
    both = np.array([-0.5 * position, position])
    return serialized(
        STORE.types[kind](header=message.header, name=["hand", "rod"], position=both, velocity=empty, effort=empty)
    )


def answer(folder: Path, verb: str, bags: str, out: Path, *options: str) -> dict[str, Any]:
    """The numbers that a verb prints."""
    given = [word.format(bags=folder / bags, out=out) for word in VERBS[verb]]
    assert main([*given, *options, "--quiet", "--json", str(out.with_suffix(".json"))]) in (0, 1)
    found = json.loads(out.with_suffix(".json").read_text())
    if verb == "compare":
        return {key: found["runs"][0][key] for key in ("samples", "error", "free_run")}
    return {key: found[key] for key in (("parameters", "map") if verb == "identify" else ("samples", "final_state"))}


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize(
    ("bags", "options", "alone"),
    [
        ("axes", ["--namespace", "left"], "left"),
        ("axes", ["--namespace", "/right/"], "right"),
        ("joints", ["--joint", "rod"], "right"),
    ],
)
def test_the_axis_that_is_meant_is_taken(
    verb: str, bags: str, options: list[str], alone: str, folder: Path, tmp_path: Path
) -> None:
    chosen = answer(folder, verb, bags, tmp_path / "chosen", *options)
    assert chosen == answer(folder, verb, alone, tmp_path / "alone")
    other = next(side for side in SIDES if side != alone)
    assert chosen != answer(folder, verb, other, tmp_path / "other")


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize(
    ("bags", "options", "words"),
    [
        ("axes", [], "run_1 holds 2 axes: /left, /right. Say which: --namespace /left"),
        ("axes", ["--namespace", "rihgt"], "unknown namespace 'rihgt'; did you mean /right?"),
        ("joints", [], "joint_states has several joints (hand, rod); say which is the piston: --joint hand"),
        ("joints", ["--joint", "rd"], "unknown joint 'rd'; did you mean rod?"),
    ],
)
def test_the_choice_is_asked_for(
    verb: str, bags: str, options: list[str], words: str, folder: Path, tmp_path: Path, capsys: Any
) -> None:
    out = tmp_path / "out"
    given = [word.format(bags=folder / bags, out=out) for word in VERBS[verb]]
    assert main([*given, *options]) == 3
    assert words in capsys.readouterr().err
    assert not out.exists()
