"""The identification as a process: recordings in; results, machine files and diagnostics out."""

import json
import shutil
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from ros.campaign_bags import record_campaign
from ros.probe import LATCHED, Probe, probe
from ros.processes import Running, node, running
from std_msgs.msg import String

from pneumo_ros.plant import load_model, model_from_dict
from pneumo_ros.records import BagTopic, BagWriter, write_recording

AXIS = load_model("axis")
TRUTH = {
    "lugre_friction.coulomb_friction": 62.0,
    "lugre_friction.static_friction": 92.0,
    "quadratic_drag.coefficient": 5100.0,
}
LONG = 120.0  # s: the machine may be busy


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Four runs of a machine with other friction than the default; every second one is enough to identify it."""
    truth = AXIS.with_parameters(TRUTH)
    return record_campaign(tmp_path_factory.mktemp("bags"), truth, (0.83, 3.0), 3.0)


def identification(place: Path, namespace: str, **parameters: object) -> list[str]:
    """Command of the node; it watches place/runs and begins at once."""
    given = {"folder": place / "runs", "output": place / "out", "quiet": 0.0, **parameters}
    return node("identification", "-r", f"__ns:=/{namespace}", **given)


class Listener:
    """A probe that hears the results of the identification in its namespace."""

    def __init__(self, one: Probe) -> None:
        self.probe = one
        self.messages = one.hear("identification/result", String, LATCHED)

    def result(self, count: int = 1) -> dict[str, Any]:
        """The result number `count`, once it has arrived."""
        self.probe.wait(lambda: len(self.messages) >= count, f"result {count}", LONG)
        return dict(json.loads(self.messages[count - 1].data))

    def applied(self) -> dict[str, Any]:
        """The outcome of the parameters on the target."""
        self.probe.wait(lambda: self.messages and json.loads(self.messages[-1].data)["applied"], "applied", LONG)
        return dict(json.loads(self.messages[-1].data)["applied"])

    def health(self) -> tuple[str, dict[str, str]]:
        """Message and values of the next diagnostics."""
        return self.probe.health(f"{self.probe.node.get_namespace().strip('/')}/identification")

    def until_health(self, words: str) -> dict[str, str]:
        """Values of the first diagnostics with these words in message or values."""
        end = time.monotonic() + LONG
        while True:
            message, values = self.health()
            if words in message or words in str(values):
                return values
            assert time.monotonic() < end, f"never in diagnostics: {words}; last: {message} {values}"


@contextmanager
def listener(namespace: str) -> Iterator[Listener]:
    """A listener that ends with the block."""
    with probe(namespace) as one:
        yield Listener(one)


@contextmanager
def simulating(hears: Listener, command: list[str], place: Path) -> Iterator[Running]:
    """A simulator that already runs: the wait for a target is short, but its kernel may have to be compiled."""
    with running(*command, cwd=place) as simulator:
        hears.probe.wait(lambda: hears.probe.heard["joint_states"], "a simulator that runs", LONG)
        yield simulator


def put(bags: list[Path], folder: Path) -> None:
    """Copy bags into folder/runs; each appears in one step."""
    (folder / "runs").mkdir(exist_ok=True)
    for bag in bags:
        shutil.copytree(bag, folder / "runs" / f".{bag.name}")
        (folder / "runs" / f".{bag.name}").rename(folder / "runs" / bag.name)


def children(pid: int) -> list[int]:
    """Running child processes of process `pid`."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text(encoding="utf-8").rpartition(")")[2].split()
        except OSError:  # it has just ended
            continue
        if int(fields[1]) == pid and fields[0] != "Z":
            found.append(int(stat.parent.name))
    return found


def at_work(process: Running) -> int:
    """The worker process, once it has started its work."""
    process.wait_for("10 %")
    (worker,) = children(process.process.pid)
    return worker


def test_bags_are_picked_up_identified_written_and_reported(tmp_path: Path, bags: list[Path]) -> None:
    put(bags[:3], tmp_path)
    with listener("whole") as hears, running(*identification(tmp_path, "whole"), cwd=tmp_path) as process:
        first = hears.result()
        assert sorted(first["recordings"]) == sorted(bag.name for bag in bags[:3])
        for name, truth in TRUTH.items():
            one = first["parameters"][name]
            assert one["determined"]
            assert one["low"] < one["value"] < one["high"]
            assert one["value"] == pytest.approx(truth, rel=0.02), name
        written = tmp_path / "out" / "axis_1.yaml"
        assert first["machine_file"] == str(written)
        before = written.read_bytes()
        machine = load_model(written)
        assert (
            machine["lugre_friction.coulomb_friction"]
            == first["parameters"]["lugre_friction.coulomb_friction"]["value"]
        )
        hears.probe.wait(lambda: len(hears.probe.heard["description"]) >= 2, "a new description")
        described = json.loads(hears.probe.heard["description"][-1].data)
        assert model_from_dict(described["model"], "axis", AXIS.library).parameters == machine.parameters

        put(bags[3:], tmp_path)
        second = hears.result(2)
        assert len(second["recordings"]) == len(bags)
        assert second["machine_file"] == str(tmp_path / "out" / "axis_2.yaml")
        assert written.read_bytes() == before
        with listener("whole") as late:
            assert late.result()["machine_file"] == second["machine_file"]
        values = hears.until_health("axis_2.yaml")
        assert values["identifications"] == "2"
        assert process.end(signal.SIGINT) == 0, process.said
    (said, *_) = [line for _, line in process.lines if "recordings in" in line]
    assert "lugre_friction.coulomb_friction" in said
    for unit in (" N;", " N s2/m2", " N/m"):
        assert unit in said
    full = json.loads(written.with_suffix(".json").read_text(encoding="utf-8"))
    assert len(full["map"]["points"]["velocity"]) > 5
    assert "Traceback" not in process.said


def test_services_answer_while_it_works(tmp_path: Path, bags: list[Path]) -> None:
    put(bags, tmp_path)
    command = identification(tmp_path, "busy", auto=False, whole_model=True)
    with listener("busy") as hears, running(*command, cwd=tmp_path) as process:
        hears.until_health(f"'recordings_ready': '{len(bags)}'")
        answer = hears.probe.trigger("identification/identify")
        assert answer.success, answer.message
        assert f"{len(bags)} recordings" in answer.message
        worker = at_work(process)
        again = [hears.probe.trigger("identification/identify") for _ in range(3)]
        assert worker in children(process.process.pid)
        assert not hears.messages
        for answer in again:
            assert not answer.success
            assert "already at work" in answer.message
        assert process.end(signal.SIGTERM) == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_ends_cleanly_while_it_works(number: signal.Signals, tmp_path: Path, bags: list[Path]) -> None:
    put(bags, tmp_path)
    with running(*identification(tmp_path, "ended"), cwd=tmp_path) as process:
        worker = at_work(process)
        assert process.end(number) == 0, process.said
    assert not (Path("/proc") / str(worker)).exists()
    assert "Traceback" not in process.said
    assert not (tmp_path / "out").exists()


def test_a_bag_being_written_waits(tmp_path: Path, bags: list[Path]) -> None:
    put(bags[:2], tmp_path)
    writer = BagWriter(tmp_path / "runs" / "open", [BagTopic("/valve/command", "std_msgs/msg/Float64")])
    command = identification(tmp_path, "waits", auto=False)
    with listener("waits") as hears, running(*command, cwd=tmp_path) as process:
        hears.until_health("'recordings_ready': '2'")
        writer.flush()
        answer = hears.probe.trigger("identification/identify")
        assert answer.success
        assert "left out: open is still being written" in answer.message
        assert len(hears.result()["recordings"]) == 2
        writer.close()
        assert process.end(signal.SIGINT) == 0


def test_refusals_are_reported_and_the_rest_is_used(tmp_path: Path, bags: list[Path]) -> None:
    put(bags[:2], tmp_path)
    with (tmp_path / "runs" / "garbage.db3").open("wb") as garbage:
        garbage.write(b"no database")
    still = np.zeros(500)
    write_recording(tmp_path / "runs" / "blind", time=0.002 * np.arange(500), position=still, voltage=still)
    with listener("refuses") as hears, running(*identification(tmp_path, "refuses"), cwd=tmp_path) as process:
        result = hears.result()
        assert {Path(path).name for path in result["refused_recordings"]} == {"garbage.db3", "blind"}
        assert len(result["recordings"]) == 2
        hears.until_health("lacks chamber_a/pressure")
        assert process.end(signal.SIGINT) == 0


@pytest.mark.check
def test_too_little_is_an_error_on_diagnostics_and_no_end(tmp_path: Path, bags: list[Path]) -> None:
    command = identification(tmp_path, "little", bags=[str(tmp_path / "later")], folder="")
    with listener("little") as hears, running(*command, cwd=tmp_path) as process:
        hears.until_health("does not exist yet")
        answer = hears.probe.trigger("identification/identify")
        assert not answer.success
        assert answer.message == "no recording is ready: later does not exist yet"
        still = np.zeros(1000)
        pressures = {"pressure_a": still + 2e5, "pressure_b": still + 2e5}
        write_recording(tmp_path / "later", time=0.002 * np.arange(1000), position=still, voltage=still, **pressures)
        hears.until_health("pneumo experiment constant-voltage")
        assert hears.probe.set("identification", bags=[str(bag) for bag in bags]) == (True, "")
        assert len(hears.result()["recordings"]) == len(bags)
        assert process.end(signal.SIGINT) == 0


def test_what_is_identified_is_set_on_a_simulator_all_at_once(tmp_path: Path, bags: list[Path]) -> None:
    put(bags[::2], tmp_path)
    command = identification(tmp_path, "apply", apply=True, target="/apply/simulator")
    with (
        listener("apply") as hears,
        simulating(hears, node("simulator", "-r", "__ns:=/apply"), tmp_path) as simulator,
        running(*command, cwd=tmp_path) as process,
    ):
        applied = hears.applied()
        assert applied["successful"], applied
        assert set(TRUTH) <= set(applied["parameters"])
        for name, value in applied["parameters"].items():
            assert hears.probe.get("simulator", name) == value
        assert hears.probe.get("simulator", "piston.mass") == AXIS["piston.mass"]
        hears.until_health("set on /apply/simulator")
        assert process.end(signal.SIGINT) == 0
        assert simulator.end(signal.SIGINT) == 0


@pytest.mark.check
def test_a_target_that_refuses_keeps_everything_and_the_reason_is_reported(tmp_path: Path, bags: list[Path]) -> None:
    put(bags[::2], tmp_path)
    effects = [name for name in AXIS.effects if name != "quadratic_drag"]
    plant = node("simulator", "-r", "__ns:=/refuse", effects=effects)
    with (
        listener("refuse") as hears,
        simulating(hears, plant, tmp_path) as simulator,
        running(*identification(tmp_path, "refuse", apply=True), cwd=tmp_path) as process,
    ):
        applied = hears.applied()
        assert not applied["successful"]
        assert applied["reason"].startswith("simulator lacks quadratic_drag.coefficient: unknown parameter")
        name = "lugre_friction.coulomb_friction"
        assert hears.probe.get("simulator", name) == AXIS[name]
        hears.until_health("refused by simulator")
        assert process.end(signal.SIGINT) == 0
        assert simulator.end(signal.SIGINT) == 0


@pytest.mark.check
def test_a_target_that_is_not_there_is_named(tmp_path: Path, bags: list[Path]) -> None:
    put(bags[::2], tmp_path)
    command = identification(tmp_path, "alone", apply=True, target="/nobody/simulator")
    with listener("alone") as hears, running(*command, cwd=tmp_path) as process:
        assert hears.applied()["reason"] == "/nobody/simulator is not there within 5 s"
        assert process.end(signal.SIGINT) == 0


def test_the_whole_model_is_refitted_if_asked(tmp_path: Path, bags: list[Path]) -> None:
    put(bags[::2], tmp_path)
    command = identification(tmp_path, "refit", whole_model=True)
    with listener("refit") as hears, running(*command, cwd=tmp_path) as process:
        result = hears.result()
        refitted = result["refit"]["parameters"]
        assert {"arctan_flow.voltage_gain", "lugre_friction.coulomb_friction"} <= set(refitted)
        machine = load_model(result["machine_file"])
        for name, one in refitted.items():
            assert machine[name] == one["value"]
        assert machine["lugre_friction.coulomb_friction"] == pytest.approx(62.0, rel=0.02)
        assert process.end(signal.SIGINT) == 0


def test_an_unknown_machine_ends_it_with_a_sentence(tmp_path: Path) -> None:
    with running(*identification(tmp_path, "unknown", model="axs"), cwd=tmp_path) as process:
        assert process.end(None) == 3
    assert "machine file axs cannot be read" in process.said
