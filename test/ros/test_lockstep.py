"""Lockstep with the controller: faster than real time, repeatable to the bit, and open loop without a controller."""

import signal
from pathlib import Path

import pytest
from ros.probe import Probe, probe, stamp
from ros.processes import node, running

LOCKSTEP = {
    "real_time_factor": 0.0,
    "start_paused": True,
    "publish_rate": 500.0,
    "noise_position": 1e-5,
    "quantisation_pressure": 10.0,
    "lockstep_wait": 60.0,  # on a busy machine a controller starts late, and its commands stay away for seconds
    "lockstep_timeout": 10.0,
}
SINE = {"reference.shape": "sine", "reference.amplitude": 0.2, "reference.frequency": 0.2}
SPAN = 3.0  # s of simulated time
ENOUGH = int(SPAN * 500)  # samples to be heard, as many as there are in SPAN

Samples = dict[int, tuple[float, float, float]]


def heard(one: Probe) -> Samples:
    """Joint states by stamp, at least of the first SPAN seconds, of a simulator that waits for its start.

    A fast publisher outruns its listener at times, on a busy machine most of the time: it goes on until enough came.
    """
    messages = one.heard["joint_states"]
    one.wait(lambda: one.node.count_publishers("joint_states"), "a simulator")
    one.wait(lambda: one.node.count_publishers("valve/command"), "a controller")
    assert one.pause(False).success
    one.wait(lambda: len(messages) > ENOUGH and stamp(messages[-1]) > SPAN * 1e9, f"{ENOUGH} samples and {SPAN} s")
    return {stamp(m): (m.position[0], m.velocity[0], m.effort[0]) for m in list(messages)}


def together(tmp_path: Path, namespace: str, **more: object) -> Samples:
    """One run of both nodes in one process."""
    command = node("axis", "-r", f"__ns:=/{namespace}", **LOCKSTEP, **SINE, **more)
    with probe(namespace) as one, running(*command, cwd=tmp_path) as process:
        samples = heard(one)
        assert process.end(signal.SIGTERM) == 0, process.said
    return samples


def apart(tmp_path: Path, namespace: str) -> Samples:
    """One run of two processes."""
    place = ("-r", f"__ns:=/{namespace}")
    plant, control = node("simulator", *place, **LOCKSTEP), node("controller", *place, use_sim_time=True, **SINE)
    with (
        probe(namespace) as one,
        running(*plant, cwd=tmp_path) as simulator,
        running(*control, cwd=tmp_path) as controller,
    ):
        samples = heard(one)
        assert controller.end(signal.SIGINT) == 0, controller.said
        assert simulator.end(signal.SIGINT) == 0, simulator.said
    return samples


def assert_same_run(one: Samples, other: Samples) -> None:
    """Samples that arrived in both runs are equal; of two busy listeners each hears other ones, a few hundred alike."""
    common = sorted(one.keys() & other.keys())
    assert len(common) > 0.1 * ENOUGH
    assert [one[s] for s in common] == [other[s] for s in common]
    assert max(abs(one[s][0]) for s in common) > 0.1


@pytest.mark.check
def test_runs_repeat_bit_for_bit_in_one_process_and_in_two(tmp_path: Path) -> None:
    first = together(tmp_path, "first")
    assert_same_run(first, together(tmp_path, "second"))
    assert_same_run(first, apart(tmp_path, "third"))


@pytest.mark.check
def test_another_seed_gives_another_run(tmp_path: Path) -> None:
    first, other = together(tmp_path, "seed_0"), together(tmp_path, "seed_1", seed=1)
    differing = [s for s in first.keys() & other.keys() if first[s] != other[s]]
    assert len(differing) > 0.1 * ENOUGH


def test_without_a_controller_it_says_so_and_runs_open_loop(tmp_path: Path) -> None:
    command = node("simulator", "-r", "__ns:=/alone", **{**LOCKSTEP, "start_paused": False, "lockstep_wait": 0.5})
    with running(*command, cwd=tmp_path) as process, probe("alone") as one:
        process.wait_for("no controller within 0.5 s")
        process.wait_for("open loop")
        begin = stamp(one.more("joint_states")[-1])
        one.wait(lambda: stamp(one.heard["joint_states"][-1]) > begin + 5e9, "5 s of simulated time")
        assert one.pause(True).success
        one.trigger("simulator/step")
        assert one.trigger("simulator/reset").success
        assert one.pause(False).success
        assert process.end() == 0


def test_a_controller_that_dies_is_not_waited_for(tmp_path: Path) -> None:
    place = ("-r", "__ns:=/orphan")
    plant = node("simulator", *place, real_time_factor=0.0, lockstep_timeout=0.3)
    control = node("controller", *place, use_sim_time=True, **SINE)
    with (
        running(*plant, cwd=tmp_path) as process,
        running(*control, cwd=tmp_path) as controller,
        probe("orphan") as one,
    ):
        one.wait(lambda: one.heard["valve/command"], "a command")
        controller.process.kill()
        process.wait_for("no command within 0.3 s")
        process.wait_for("controller left; the plant runs open loop")

        def closed() -> dict[str, str] | None:
            values = one.health("orphan/simulator")[1]
            return values if values["voltage_V"] == "0" else None

        assert int(one.wait(closed, "a closed valve")["command_timeouts"]) >= 3
        assert process.end() == 0
