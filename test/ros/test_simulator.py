"""The simulator as a process: its output, its input, refusals and changes while it runs."""

import json
import math
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import yaml
from ros.probe import BEST_EFFORT, Probe, probe, stamp
from ros.processes import Running, node, running

from pneumo_ros.plant import load_model, model_from_dict

AXIS = load_model("axis")


@pytest.fixture(scope="module")
def simulator(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Running]:
    """One simulator for the tests that do not change it."""
    with running(*node("simulator", publish_rate=500.0), cwd=tmp_path_factory.mktemp("simulator")) as process:
        yield process
        assert process.end(signal.SIGINT) == 0, process.said


@pytest.fixture(scope="module")
def one_probe(simulator: Running) -> Iterator[Probe]:
    with probe() as one:
        one.matched(one.command)
        one.more("joint_states")
        yield one


@pytest.fixture
def axis(one_probe: Probe) -> Probe:
    """The simulator, reset, seen by a probe."""
    assert one_probe.trigger("simulator/reset").success
    return one_probe


def positions(messages: list) -> np.ndarray:
    return np.array([message.position[0] for message in messages])


def test_a_joint_state_is_complete_and_the_pressures_share_its_stamp(axis: Probe) -> None:
    axis.send(2.0, 0.3)
    for name in ("joint_states", "chamber_a/pressure", "chamber_b/pressure"):
        axis.heard[name].clear()
    message = axis.more("joint_states", 20)[10]
    assert list(message.name) == ["piston"]
    pressures = [
        next(p.fluid_pressure for p in axis.heard[f"chamber_{c}/pressure"] if stamp(p) == stamp(message)) for c in "ab"
    ]
    areas = AXIS["piston.area_a"], AXIS["piston.area_b"]
    effort = areas[0] * pressures[0] - areas[1] * pressures[1] - 1e5 * (areas[0] - areas[1])
    assert message.effort[0] == pytest.approx(effort, rel=1e-12)
    assert len(message.position) == len(message.velocity) == 1
    frames = {p.header.frame_id for c in "ab" for p in axis.heard[f"chamber_{c}/pressure"]}
    assert frames == {"piston_tube"}  # the link of urdf/cylinder.xacro, one for each joint


def test_stamps_are_as_even_as_the_rate_and_follow_the_clock(axis: Probe) -> None:
    messages = axis.more("joint_states", 200)
    steps = np.diff([stamp(message) for message in messages])
    assert np.mean(np.abs(steps - 2_000_000) < 1000) > 0.9  # but where a busy machine lost messages or time
    assert abs(stamp(messages[-1]) * 1e-9 - time.time()) < 0.5


def test_it_moves_as_the_model_says(axis: Probe) -> None:
    """The same speed at each position, not at each time: a busy machine may have lost time."""
    y, v = AXIS.simulate(np.full(1500, 2.0), AXIS.state(), sample_time=0.002)[:, :2].T
    heard = axis.heard["joint_states"]
    axis.wait(lambda: abs(heard[-1].position[0]) < 1e-6, "the start")
    heard.clear()
    assert axis.set("simulator", command_timeout=0.0) == (True, "")
    axis.send(2.0)
    axis.wait(lambda: heard and heard[-1].position[0] > 0.25, "motion")
    assert axis.set("simulator", command_timeout=0.1) == (True, "")
    states = np.array([(one.position[0], one.velocity[0]) for one in heard if 0.01 < one.position[0] < 0.25])
    assert len(states) > 100
    np.testing.assert_allclose(states[:, 1], np.interp(states[:, 0], y, v), rtol=0.01)


def test_the_valve_closes_when_commands_stop(axis: Probe) -> None:
    before = int(axis.health("simulator")[1]["valve_closures"])
    for _ in range(100):
        axis.send(2.0, 0.2)
        if axis.heard["joint_states"][-1].velocity[0] > 0.05:
            break
    axis.wait(lambda: float(axis.health("simulator")[1]["voltage_V"]) == 0.0, "a closed valve")
    pressures = [axis.more("chamber_a/pressure")[0].fluid_pressure]
    axis.wait(lambda: abs(axis.heard["joint_states"][-1].velocity[0]) < 1e-3, "rest")
    pressures.append(axis.more("chamber_a/pressure")[0].fluid_pressure)
    _, values = axis.health("simulator")
    assert float(values["voltage_V"]) == 0.0
    assert int(values["valve_closures"]) > before  # a late command of the test closes it, too
    assert max(pressures) < 6.9e5  # an open valve would have filled it to the supply's 7 bar


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_command_that_is_not_a_number_is_refused_and_counted(axis: Probe, bad: float) -> None:
    before = int(axis.health("simulator")[1]["rejected_inputs"])

    def refused() -> bool:
        axis.send(bad, 0.2)
        message, values = axis.health("simulator")
        return "refused" in message and int(values["rejected_inputs"]) > before

    axis.wait(refused, "a refusal on /diagnostics")
    assert axis.more("joint_states")[0].velocity[0] == pytest.approx(0.0, abs=1e-6)


def test_a_command_out_of_range_is_clipped_and_counted(axis: Probe) -> None:
    before = int(axis.health("simulator")[1]["saturated_inputs"])
    axis.send(50.0, 1.2)
    _, values = axis.health("simulator")
    assert int(values["saturated_inputs"]) > before
    assert float(values["voltage_V"]) in (10.0, 0.0)
    assert axis.heard["joint_states"][-1].position[0] > 0.05


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"piston__mass": -1.0}, "piston.mass"),
        ({"piston__mass": math.nan}, "piston.mass"),
        ({"noise_position": 1.0}, "noise_position"),
        ({"publish_rate": 100.0}, "read-only"),
        ({"effects": ["dead_zone", "arctan_flow", "lugre_frction"]}, "lugre_friction"),
        ({"initial__y": 5.0}, "stroke"),
        ({"piston__mass": 7.0, "air__temperature": -3.0}, "air.temperature"),
    ],
)  # fmt: skip
def test_a_bad_value_is_refused_with_the_reason_and_the_old_one_stays(axis: Probe, change: dict, said: str) -> None:
    names = [name.replace("__", ".") for name in change]
    before = [axis.get("simulator", name) for name in names]
    done, reason = axis.set("simulator", **change)
    assert not done
    assert said in reason
    assert [axis.get("simulator", name) for name in names] == before


def test_a_whole_number_serves_as_a_real_one(axis: Probe) -> None:
    assert axis.set("simulator", piston__mass=6) == (True, "")
    assert axis.get("simulator", "piston.mass") == 6.0
    assert axis.set("simulator", piston__mass=5.0) == (True, "")


def test_parameters_have_units_finite_ranges_and_no_steps(axis: Probe) -> None:
    described = axis.describe("simulator", "air.supply_pressure")
    assert "[Pa]" in described.description
    span = described.floating_point_range[0]
    assert math.isfinite(span.from_value)
    assert math.isfinite(span.to_value)
    assert span.step == 0.0
    assert axis.describe("simulator", "publish_rate").read_only


def test_physics_changes_under_way_without_a_jump_of_the_state(axis: Probe) -> None:
    axis.send(2.0, 0.5)
    for values in ({"piston__mass": 15.0}, {"air__supply_pressure": 5e5}, {"lugre_friction__coulomb_friction": 90.0}):
        for topic in ("joint_states", "chamber_a/pressure"):
            axis.heard[topic].clear()
        axis.send(2.0, 0.05)
        assert axis.set("simulator", **values) == (True, "")
        axis.send(2.0, 0.1)
        assert np.abs(np.diff(positions(axis.heard["joint_states"]))).max() < 0.002 * 0.5  # 0.5 m/s over a sample
        pressure = np.array([message.fluid_pressure for message in axis.heard["chamber_a/pressure"]])
        assert np.abs(np.diff(pressure)).max() < 1e4
    restored = {"piston__mass": 5.0, "air__supply_pressure": 7e5, "lugre_friction__coulomb_friction": 70.0}
    assert axis.set("simulator", **restored) == (True, "")


def test_effects_are_switched_under_way(axis: Probe) -> None:
    without = [name for name in AXIS.effects if name != "quadratic_drag"]
    voltage = 2.0
    axis.send(voltage, 0.3)
    axis.heard["joint_states"].clear()
    axis.heard["description"].clear()
    assert axis.set("simulator", effects=without) == (True, "")

    def shuttle() -> None:
        """Move to and fro in mid stroke, as a kernel may take long to compile."""
        nonlocal voltage
        if abs(position := axis.more("joint_states")[-1].position[0]) > 0.4:
            voltage = -math.copysign(2.0, position)
        axis.send(voltage, 0.02)

    def switched() -> bool:
        shuttle()
        messages = [json.loads(message.data) for message in axis.heard["description"]]
        return any(message["model"]["effects"] == without for message in messages)

    axis.wait(switched, "a description without quadratic_drag")

    def fast() -> bool:
        shuttle()
        return max(abs(message.velocity[0]) for message in axis.heard["joint_states"]) > 0.5

    axis.wait(fast, "more than 0.5 m/s: the drag had set the top speed")
    heard = list(axis.heard["joint_states"])
    between = np.diff([stamp(message) for message in heard]) * 1e-9  # s; a busy machine loses messages
    assert np.all(np.abs(np.diff(positions(heard))) < 5.0 * between)
    assert "quadratic_drag.coefficient" not in axis.names("simulator")
    assert axis.set("simulator", effects=list(AXIS.effects)) == (True, "")
    axis.wait(lambda: "quadratic_drag" in axis.heard["description"][-1].data, "the old effects")
    assert axis.get("simulator", "quadratic_drag.coefficient") == AXIS["quadratic_drag.coefficient"]


def test_pause_holds_step_goes_one_sample_and_reset_starts_again(axis: Probe) -> None:
    axis.send(2.0, 0.3)
    assert axis.pause(True).success
    axis.quiet("joint_states")
    axis.heard["joint_states"].clear()
    axis.send(2.0)
    assert axis.trigger("simulator/step").success
    assert axis.trigger("simulator/step").success
    stepped = axis.heard["joint_states"]
    axis.wait(lambda: len(stepped) >= 2, "two samples")
    axis.quiet("joint_states")
    assert len(stepped) == 2
    moved = stepped[1].position[0] - stepped[0].position[0]
    mean = 0.5 * (stepped[0].velocity[0] + stepped[1].velocity[0])  # a busy machine may still be at its start
    assert moved == pytest.approx(0.002 * mean, rel=0.1)
    assert axis.pause(False).success
    assert not axis.trigger("simulator/step").success  # it runs
    assert axis.trigger("simulator/reset").success
    axis.wait(lambda: abs(axis.more("joint_states")[-1].position[0]) < 1e-6, "the start")


def test_a_late_best_effort_subscriber_learns_what_machine_it_sees(axis: Probe) -> None:
    with probe(qos=BEST_EFFORT) as late:
        assert late.more("joint_states")
        late.wait(lambda: late.heard["description"], "a description")
        said = json.loads(late.heard["description"][0].data)
    assert said["schema_version"] == 1
    assert said["seed"] == 0
    model = model_from_dict(said["model"], "described", AXIS.library)
    assert dict(model.parameters) == dict(AXIS.parameters)


def test_diagnostics_say_how_well_it_keeps_time(axis: Probe) -> None:
    _, values = axis.health("simulator")
    assert {"real_time_factor", "late_ticks", "command_age_s", "rejected_inputs", "saturated_inputs"} <= set(values)
    assert 0.0 < float(values["real_time_factor"]) < 2.0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_end_it_with_0(tmp_path: Path, number: int) -> None:
    with running(*node("simulator", "-r", "__ns:=/ending"), cwd=tmp_path) as process, probe("ending") as one:
        one.more("joint_states")
        assert process.end(number) == 0
        assert "Traceback" not in process.said


@pytest.mark.parametrize("name", ["simulator", "controller", "recorder", "identification"])
def test_a_second_signal_at_any_moment_of_the_end_changes_nothing(tmp_path: Path, name: str) -> None:
    """As under `ros2 launch`, where both the terminal and launch send SIGINT."""
    with running(*node(name, "-r", "__ns:=/twice"), cwd=tmp_path) as process:
        process.wait_for("ready")  # logged at INFO once it runs
        while process.process.poll() is None:
            process.process.send_signal(signal.SIGINT)
            time.sleep(1e-3)
        assert process.end(None) in (0, 130), process.said


@pytest.mark.parametrize(
    ("parameters", "code", "said"),
    [
        ({"publsh_rate": 100.0}, 2, "did you mean publish_rate?"),
        ({"effects": ["dead_zne"]}, 2, "did you mean dead_zone"),
        ({"piston.mas": 3.0}, 2, "did you mean piston.mass"),
        ({"air.temperature": -1.0}, 2, "air.temperature"),
        ({"model": "emps"}, 2, "emps has no chambers"),
        ({"model": "axle"}, 3, "give a YAML file or one of: axis"),
    ],
)  # fmt: skip
def test_it_refuses_to_start_with_what_it_does_not_understand(
    tmp_path: Path, parameters: dict, code: int, said: str
) -> None:
    with running(*node("simulator", **parameters), cwd=tmp_path) as process:
        assert process.end(None) == code
        assert said in process.said
        assert len(process.lines) == 1, process.said


def test_a_machine_file_is_a_parameter_file_and_nothing_may_be_missing_in_it(tmp_path: Path) -> None:
    from importlib.resources import files

    text = (files("pneumo_ros.config") / "paper.yaml").read_text()
    whole, broken = tmp_path / "whole.yaml", tmp_path / "broken.yaml"
    whole.write_text(text)
    broken.write_text("\n".join(line for line in text.splitlines() if "stroke:" not in line))
    with running(*node("simulator", "--params-file", str(broken)), cwd=tmp_path) as process:
        assert process.end(None) == 2
        assert "piston.stroke is missing" in process.said
    command = node("simulator", "--params-file", str(whole), "-r", "__ns:=/whole", **{"piston.mass": 7})
    with running(*command, cwd=tmp_path) as process, probe("whole") as one:
        one.wait(lambda: one.heard["description"], "a description")
        machine = json.loads(one.heard["description"][-1].data)["model"]
        assert process.end() == 0
    assert "rod_atmospheric_force" not in machine["effects"]
    assert machine["piston"]["mass"] == 7.0


def dump(one: Probe, node: str) -> str:
    """What `ros2 param dump` prints: nested by the dots of the names, below the node's full name."""
    nested: dict = {}
    for name in one.names(node):
        *sections, key = name.split(".")
        inner = nested
        for section in sections:
            inner = inner.setdefault(section, {})
        value = one.get(node, name)
        inner[key] = list(value) if isinstance(value, (list, tuple)) else value
    return yaml.dump({f"{one.node.get_namespace()}/{node}": {"ros__parameters": nested}}, default_flow_style=False)


def test_a_dump_of_its_parameters_is_a_machine_file(tmp_path: Path) -> None:
    fewer = [name for name in AXIS.effects if name != "quadratic_drag"]
    with running(*node("simulator", "-r", "__ns:=/dumped"), cwd=tmp_path) as process, probe("dumped") as one:
        assert one.set("simulator", piston__mass=6.5, effects=fewer) == (True, "")
        one.wait(lambda: "compiling" not in one.health("dumped/simulator")[0], "a kernel without the drag")
        (tmp_path / "dump.yaml").write_text(dump(one, "simulator"))
        assert process.end() == 0
    model = load_model(tmp_path / "dump.yaml")
    assert list(model.effects) == fewer
    assert dict(model.parameters) == {**AXIS.with_effects(fewer).parameters, "piston.mass": 6.5}
    command = node("simulator", "--params-file", "dump.yaml", "-r", "__ns:=/dumped")
    with running(*command, cwd=tmp_path) as process, probe("dumped") as one:
        assert one.get("simulator", "piston.mass") == 6.5
        assert process.end() == 0


RUNAWAY = """
from pneumo_ros.plant import Effect, Parameter


class Runaway(Effect):
    \"\"\"Negative friction that no step is short enough for.\"\"\"

    gain = Parameter(1e9, "N s3/m3", "force per cubed velocity", low=0.0)

    def equations(v, gain):
        force = -gain * v * v * v
        return force
"""


def test_an_effect_of_ones_own_and_a_state_that_leaves_the_finite_numbers(tmp_path: Path) -> None:
    (tmp_path / "runaway.py").write_text(RUNAWAY)
    command = node("simulator", "-r", "__ns:=/runaway", effects=[*AXIS.effects, "runaway"])
    command[2:2] = ["--effects", "runaway.py"]
    with running(*command, cwd=tmp_path) as process, probe("runaway") as one:
        one.matched(one.command)
        one.more("joint_states")

        def exploded() -> bool:
            one.send(2.0, 0.02)
            return "left the finite numbers" in process.said

        one.wait(exploded, "an explosion")
        message, _ = one.health("runaway/simulator")
        assert "left the finite numbers" in message
        assert not one.pause(False).success
        assert all(math.isfinite(m.position[0]) for m in one.heard["joint_states"])
        assert one.set("simulator", runaway__gain=0.0) == (True, "")
        assert one.trigger("simulator/reset").success
        assert one.more("joint_states", 3)[-1].position[0] == pytest.approx(0.0, abs=1e-6)
        assert process.end() == 0


def test_a_signal_at_the_very_start_ends_it_with_0_as_well(tmp_path: Path) -> None:
    """While rclpy is still being imported: as soon as the process listens to SIGTERM at all."""
    with running(*node("simulator", "-r", "__ns:=/early"), cwd=tmp_path) as process:
        status = Path(f"/proc/{process.process.pid}/status")
        while not caught(status.read_text()) >> (signal.SIGTERM - 1) & 1:
            time.sleep(1e-3)
        assert process.end(signal.SIGINT) == 0, process.said


def caught(status: str) -> int:
    """Bits of the signals that a process handles."""
    return int(next(line for line in status.splitlines() if line.startswith("SigCgt:")).split()[1], 16)
