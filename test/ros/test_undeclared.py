"""Live work is refused while nobody has said which signal closes the valve: no command leaves any node."""

import time
from pathlib import Path

import pytest
from ros.axis_probe import AxisProbe
from ros.processes import Running, node, running
from ros.scripted_plant import ScriptedPlant, scripted_plant, until
from ros.test_experiment import PROGRAMME

import pneumo_ros as pn
from pneumo_ros.experiment.programme_file import programme_text
from pneumo_ros.plant import load_model, save_model

UNDECLARED = {"closed_signal": ""}
SAID = "add -p closed_signal:=0V"


def refused(plant: ScriptedPlant, process: Running) -> None:
    """The node says what to type, and has sent nothing though the plant was heard."""
    process.wait_for(SAID)
    time.sleep(0.2)
    assert plant.commands == []


def test_a_controller_sends_nothing_to_a_rig_until_somebody_says_what_closes_its_valve(tmp_path: Path) -> None:
    place = ("-r", "__ns:=/silent")
    with scripted_plant("silent") as plant:
        with running(*node("controller", *place, **UNDECLARED), cwd=tmp_path) as process:
            refused(plant, process)
            assert process.end() == 0
        assert plant.commands == []  # nor at the end
        with running(*node("controller", *place, closed_signal=5), cwd=tmp_path) as process:
            until(lambda: plant.commands, "a command", 180.0)
            assert process.end() == 0
        assert set(plant.commands) == {5.0}


def test_an_experiment_ends_before_it_sends_anything(tmp_path: Path) -> None:
    (tmp_path / "programme.yaml").write_text(programme_text(PROGRAMME), encoding="utf-8")
    given = {"programme": tmp_path / "programme.yaml", "output": tmp_path / "out", "wait": 2.0, **UNDECLARED}
    with scripted_plant("unsaid") as plant:
        with running(*node("experiment", "-r", "__ns:=/unsaid", **given), cwd=tmp_path) as process:
            assert process.end(None) == 2, process.said
        assert SAID in process.said
        assert plant.commands == []
    assert not (tmp_path / "out").exists()


def test_recorded_commands_are_not_played_to_a_rig(tmp_path: Path) -> None:
    pn.save(pn.simulate(load_model("axis"), "step:2@0.2", seconds=0.5), tmp_path / "run")
    given = {"input": tmp_path / "run", "topics": ["*valve/command"], "wait": 10.0}
    place = ("-r", "__ns:=/played")
    with scripted_plant("played") as plant:
        with running(*node("player", *place, **given), cwd=tmp_path) as process:
            assert process.end(None) == 2, process.said
        assert SAID in process.said
        assert plant.commands == []
        with running(*node("player", *place, **given, closed_signal="0V"), cwd=tmp_path) as process:
            assert process.end(None) == 0, process.said
        until(lambda: plant.commands and plant.commands[-1] == 0.0, "the closed signal as the last command", 180.0)
        assert max(plant.commands) == 2.0


@pytest.mark.parametrize("closed", [0.0, 5.0])
def test_a_simulator_says_it_by_itself(tmp_path: Path, closed: float) -> None:
    """A controller without a machine file moves a simulator that closes at 0 V, and refuses one of 5 V."""
    axis = load_model("axis")
    made = axis.with_effects(["valve_null_offset", *axis.effects], {"valve_null_offset.offset": -closed})
    save_model(made, tmp_path / "plant.yaml")
    name = f"simulated_{closed:.0f}"
    place = ("-r", f"__ns:=/{name}")
    plant = node("simulator", *place, model=str(tmp_path / "plant.yaml"), publish_rate=200.0)
    with running(*plant, cwd=tmp_path), running(*node("controller", *place, **UNDECLARED), cwd=tmp_path) as controller:
        probe = AxisProbe(name)
        if closed:
            controller.wait_for("the simulator closes its valve at 5 V, and this node would close it at 0 V")
            assert not probe.heard["valve/command"]
        else:
            probe.wait(lambda: probe.heard["valve/command"], "a command", 300.0)
        probe.close()
        assert controller.end() == 0
