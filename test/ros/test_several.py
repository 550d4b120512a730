"""A simulator of several axes: each in a namespace of its own, on one supply."""

import json
import signal
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace

import pytest
from multiaxis.machines import LINE, two
from ros.probe import Probe, probe, stamp
from ros.processes import node, running
from sensor_msgs.msg import FluidPressure

from pneumo_ros.multiaxis import machine_text

AXES = ("shoulder", "elbow")


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The machine file of shoulder and elbow on one line."""
    path = tmp_path_factory.mktemp("machine") / "two.yaml"
    path.write_text(machine_text(two(LINE)))
    return path


@pytest.fixture(scope="module")
def arm(file: Path) -> Iterator[SimpleNamespace]:
    """A simulator of both axes below /arm, and probes of the machine and of each axis."""
    own = ("-p", "noise_position:=1e-5", "-p", "elbow.noise_position:=0.0", "-p", "elbow.initial.y:=0.1")
    command = node("simulator", "-r", "__ns:=/arm", "--params-file", str(file), *own)
    with ExitStack() as stack:
        process = stack.enter_context(running(*command, cwd=file.parent))
        one = {axis: stack.enter_context(probe(f"arm/{axis}")) for axis in AXES}
        whole = stack.enter_context(probe("arm"))
        pressures = whole.hear("supply/pressure", FluidPressure, 10)
        for axis in AXES:
            one[axis].wait(lambda axis=axis: one[axis].heard["joint_states"], f"joint states of {axis}")
        yield SimpleNamespace(process=process, axes=one, whole=whole, pressures=pressures)
        assert process.end(signal.SIGINT) == 0, process.said


def described(one: Probe) -> dict[str, object]:
    """The machine that a description holds."""
    one.wait(lambda: one.heard["description"], "a description")
    return dict(json.loads(one.heard["description"][-1].data)["model"])


def test_each_axis_has_topics_joint_and_description_and_the_machine_its_own(arm: SimpleNamespace) -> None:
    for axis, one in arm.axes.items():
        assert list(one.more("joint_states")[-1].name) == [axis]
        one.wait(lambda one=one: one.heard["chamber_a/pressure"], "pressures")
        assert "spring_load" in described(one)["effects"] or axis == "elbow"
    whole = described(arm.whole)
    assert (whole["axes"], whole["supply_pressure_droop"]) == ([*AXES], LINE)
    assert arm.axes["elbow"].heard["joint_states"][-1].position[0] == pytest.approx(0.1)  # no noise, its own start
    assert len({m.position[0] for m in arm.axes["shoulder"].more("joint_states", 10)}) > 5  # noise


def test_one_axis_moves_the_supply_drops_and_its_reset_leaves_the_other(arm: SimpleNamespace) -> None:
    elbow, shoulder = arm.axes["elbow"], arm.axes["shoulder"]
    elbow.matched(elbow.command)
    begin = len(arm.pressures)

    def moving() -> bool:
        elbow.send(4.0, 0.1)
        return bool(abs(elbow.heard["joint_states"][-1].position[0] - 0.1) > 0.05)

    elbow.wait(moving, "motion of the elbow")
    assert min(message.fluid_pressure for message in arm.pressures[begin:]) < 6.9e5  # Pa, of 7e5
    assert abs(shoulder.heard["joint_states"][-1].position[0]) < 1e-3
    before = stamp(shoulder.heard["joint_states"][-1])
    assert elbow.trigger("simulator/reset").success
    elbow.wait(lambda: elbow.heard["joint_states"][-1].position[0] == pytest.approx(0.1, abs=1e-3), "the start")
    assert stamp(shoulder.more("joint_states")[-1]) > before
    assert float(elbow.health("arm/elbow/simulator")[1]["simulated_time_s"]) < float(
        shoulder.health("arm/shoulder/simulator")[1]["simulated_time_s"]
    )


def test_parameters_and_effects_are_those_of_an_axis(arm: SimpleNamespace) -> None:
    elbow, shoulder = arm.axes["elbow"], arm.axes["shoulder"]
    assert elbow.set("simulator", piston__mass=6.0) == (True, "")
    effects = elbow.get("simulator", "effects")
    assert elbow.set("simulator", effects=[*effects, "viscous_friction"])[0]
    elbow.wait(lambda: "viscous_friction" in described(elbow)["effects"], "the new effect")
    arm.whole.wait(lambda: "viscous_friction" in described(arm.whole)["elbow"]["effects"], "the same in the whole")
    assert described(arm.whole)["elbow"]["piston"]["mass"] == 6.0
    assert "viscous_friction" not in described(shoulder)["effects"]
    refused = shoulder.set("simulator", piston__mass=-1.0)
    assert not refused[0]
    elbow.more("joint_states", 5)


def test_the_machine_pauses_and_steps_as_a_whole(arm: SimpleNamespace) -> None:
    assert arm.whole.pause(True).success
    for one in arm.axes.values():
        one.quiet("joint_states")
    counts = [len(one.heard["joint_states"]) for one in arm.axes.values()]
    assert "at " in arm.whole.trigger("simulator/step").message
    for one, count in zip(arm.axes.values(), counts, strict=True):
        one.wait(lambda one=one, count=count: len(one.heard["joint_states"]) == count + 1, "one sample")
    assert arm.whole.pause(False).success


@pytest.mark.check
def test_a_second_plant_in_the_namespace_of_an_axis_is_refused(arm: SimpleNamespace, tmp_path: Path) -> None:
    with running(*node("simulator", "-r", "__ns:=/arm/elbow"), cwd=tmp_path) as second:
        assert second.end(None) == 2
        assert "/arm/elbow/simulator is already the plant in namespace /arm/elbow" in second.said


@pytest.mark.check
@pytest.mark.parametrize(
    ("name", "place", "said"),
    [
        ("controller", (), "the machine has the axes shoulder, elbow, and a controller moves one: start it in that"),
        ("axis", (), "start a simulator, which moves all, and a controller in the namespace of each"),
        ("simulator", ("-p", "coupled:=true"), "coupled takes one axis; start a simulator for each"),
        ("simulator", ("-p", "elbow.piston.mas:=3.0"), "mass"),
        ("identification", (), "this node takes a machine file as -p model:=my.yaml"),
    ],
)
def test_what_takes_no_such_machine_says_what_to_type(
    name: str, place: tuple[str, ...], said: str, file: Path, tmp_path: Path
) -> None:
    command = node(name, "-r", "__ns:=/refused", "--params-file", str(file), *place)
    with running(*command, cwd=tmp_path) as process:
        assert process.end(None) == 2, process.said
        assert said in process.said


@pytest.mark.check
def test_the_identification_asks_for_one_axis(file: Path, tmp_path: Path) -> None:
    with running(*node("identification", model=str(file)), cwd=tmp_path) as process:
        assert process.end(None) == 2
        assert f"it has the axes shoulder, elbow; say which, such as {file}:shoulder" in process.said
