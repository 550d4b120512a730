"""Recordings of the rig: their content, their noise, and repetition by the seed."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from rig import case, command, effects, excitation
from rig.machine import WORN, Machine, rough_surface
from rig.sensors import Logger
from rosbags.highlevel import AnyReader

pytestmark = pytest.mark.check  # they judge the independent rig, not the package

CHECKOUT = Path(__file__).parents[1]
RECORDED = Path(os.environ.get("PNEUMO_RIG", CHECKOUT.parent / "shared" / "rig")) / "healthy"


def read(folder):
    """Header stamps or log times [ns] and values by topic."""
    times, values = {}, {}
    with AnyReader([folder]) as reader:
        for connection, log_time, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            header = getattr(message, "header", None)
            stamp = header.stamp.sec * 10**9 + header.stamp.nanosec if header else log_time
            value = message.position[0] if hasattr(message, "position") else None
            value = getattr(message, "fluid_pressure", getattr(message, "data", value))
            topic = connection.topic.lstrip("/")
            times.setdefault(topic, []).append(stamp)
            values.setdefault(topic, []).append(value)
    return {topic: np.array(t) for topic, t in times.items()}, {topic: np.array(v) for topic, v in values.items()}


@pytest.fixture(scope="module")
def healthy():
    built = effects.build(11)
    return {run.name: run for run in case.make_runs(built, ("constant_p7000", "train_steps", "train_creep"))}


def test_a_case_is_written_as_it_was_made(tmp_path, capsys):
    folder = tmp_path / "case"
    arguments = ["--out", str(folder), "--seed", "11", "--effect", "viscous_friction=180", "--runs", "constant_p7*"]
    assert command.main(arguments) == 0
    made = case.make_run(effects.build(11, [effects.Wish("viscous_friction", 180.0)]), "constant_p7000")
    times, values = read(folder / "constant_p7000")
    start = case.epoch(11)
    for topic, expected in {
        "joint_states": made.position,
        "chamber_a/pressure": made.pressure_a,
        "chamber_b/pressure": made.pressure_b,
    }.items():
        assert np.array_equal(values[topic], expected)
        assert np.array_equal(times[topic], start + made.stamps)
    assert np.array_equal(values["valve/command"], made.voltage[made.command_index])
    assert np.array_equal(times["valve/command"], start + made.command_index * 10**6)
    assert "viscous_friction" in capsys.readouterr().out


def test_the_truth_stands_beside_the_case_and_not_in_it(tmp_path):
    folder = tmp_path / "case"
    command.main(["--out", str(folder), "--effect", "constant_load=35", "--runs", "constant_p7000"])
    truth = json.loads((tmp_path / "case.truth.json").read_text())
    assert [(e["effect"], e["size"], e["fields"]) for e in truth["effects"]] == [
        ("constant_load", 35.0, {"load": 35.0})
    ]
    assert truth["machine"]["load"] == 35.0
    assert {path.name for path in folder.iterdir()} == {"constant_p7000"}


@pytest.mark.parametrize(("effect", "ends"), [("constant_load=35", False), ("cushioning=0.05", True)])
def test_a_pattern_takes_runs_to_the_ends_where_they_show_something(tmp_path, effect, ends):
    command.main(["--out", str(tmp_path / "case"), "--effect", effect, "--runs", "constant_p7000", "holdout_[es]nds"])
    assert (tmp_path / "case" / "holdout_ends").exists() is ends


def test_a_seed_repeats_to_the_byte_in_another_process(tmp_path):
    for name in ("one", "two"):
        options = ["--seed", "5", "--effect", "random", "--rough", "--runs", "constant_m7000", "--quiet"]
        line = [sys.executable, str(CHECKOUT / "test" / "rig"), "--out", str(tmp_path / name), *options]
        assert "hidden" not in subprocess.run(line, check=True, capture_output=True, text=True).stdout
    one, two = (sorted(path for path in (tmp_path / name).rglob("*") if path.is_file()) for name in ("one", "two"))
    assert len(one) == 2
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in two]
    assert (tmp_path / "one.truth.json").read_bytes() == (tmp_path / "two.truth.json").read_bytes()


def test_runs_do_not_depend_on_what_else_is_made(healthy):
    again = case.make_run(effects.build(11), "train_creep")
    other = case.make_run(effects.build(12), "train_creep")
    assert np.array_equal(again.position, healthy["train_creep"].position)
    assert not np.array_equal(other.position, healthy["train_creep"].position)


def test_noise_is_what_the_rig_promises(healthy):
    run = healthy["train_steps"]
    position, pressure = run.position - run.truth[:, 0], run.pressure_a - run.truth[:, 2]
    assert position.std() == pytest.approx(np.hypot(5e-6, 1e-5 / np.sqrt(12.0)), rel=0.03)
    assert pressure.std() == pytest.approx(300.0, rel=0.03)
    assert abs(position.mean()) < 2e-7
    assert abs(pressure.mean()) < 10.0
    assert run.position / 1e-5 == pytest.approx(np.round(run.position / 1e-5), abs=1e-6)
    codes = run.pressure_a * 2**16 / 1e6
    assert np.array_equal(codes, np.round(codes))


def test_another_logger_sees_the_same_motion(healthy):
    usual, built = healthy["train_creep"], effects.build(11)
    slow, fast, quiet = (
        case.make_run(built, "train_creep", logger=logger) for logger in (Logger(250), Logger(2000), Logger(noise=0.5))
    )
    assert np.array_equal(slow.position, usual.position[::4])
    assert np.array_equal(slow.stamps, usual.stamps[::4])
    assert np.array_equal(slow.voltage[slow.command_index], usual.voltage[usual.command_index])
    assert np.median(np.diff(fast.stamps)) == pytest.approx(5e5, rel=0.01)
    assert len(fast.position) == 2 * len(usual.position) == 2 * len(fast.voltage)
    noise = quiet.pressure_a - quiet.truth[:, 2]
    assert noise.std() == pytest.approx(150.0, rel=0.03)


def test_a_faster_logger_adds_readings_in_between():
    built = effects.build(11)  # a constant voltage, which no reading changes
    usual, fast = (case.make_run(built, "constant_p7000", logger=Logger(rate)) for rate in (1000, 2000))
    assert fast.truth[::2] == pytest.approx(usual.truth, rel=1e-4, abs=1e-6)


def test_clock_jitters_by_10_us_and_never_runs_back(healthy):
    run = healthy["train_steps"]
    late = run.stamps - np.arange(len(run.stamps)) * 10**6
    assert late.std() == pytest.approx(1e4, rel=0.03)
    assert np.diff(run.stamps).min() > 0
    assert np.diff(run.log_times).min() > 0


def test_commands_are_sent_on_change_and_kept_alive(healthy):
    run = healthy["constant_p7000"]
    sent = run.voltage[run.command_index]
    assert np.diff(run.command_index).max() == 100
    assert run.command_index[0] == 0
    held = np.repeat(sent, np.diff(np.append(run.command_index, len(run.voltage))))
    assert np.array_equal(held, run.voltage)


def test_constant_runs_hold_their_voltage_from_rest_near_an_end(healthy):
    run = healthy["constant_p7000"]
    assert np.all(run.voltage[:300] == 0.0)
    assert np.all(run.voltage[300:] == 7.0)
    assert run.truth[0, 0] == pytest.approx(-0.9, abs=1e-3)
    assert abs(run.truth[:300, 1]).max() < 1e-3


def test_creeping_sticks_and_slips(healthy):
    moved = np.abs(np.diff(healthy["train_creep"].truth[::50, 0]))
    assert np.mean(moved < 1e-5) > 0.2
    assert np.mean(moved > 5e-4) > 0.1


@pytest.mark.parametrize("seed", range(3))
def test_healthy_machines_stay_inside_the_stroke_and_are_worn_by_five_per_cent(seed):
    built = effects.build(seed)
    names = [name for name in excitation.RUNS if "constant" not in name]
    reach = [np.abs(run.truth[:, 0]).max() for run in case.make_runs(built, names, step=4e-5)]
    wear = [getattr(built.machine, name) / getattr(Machine(), name) - 1.0 for name in WORN]
    assert max(reach) < 0.98
    assert max(np.abs(wear)) <= 0.05
    assert max(np.abs(wear)) > 0.02


def test_roughness_has_its_sizes_and_repeats_with_position():
    rough = rough_surface(np.random.default_rng(1), np.random.default_rng(2), 400000)
    other = rough_surface(np.random.default_rng(1), np.random.default_rng(3), 400000)
    assert rough.force.std() == pytest.approx(0.3, rel=0.05)
    assert np.corrcoef(rough.force[:-1], rough.force[1:])[0, 1] == pytest.approx(np.exp(-0.01 * np.pi), abs=0.01)
    assert rough.texture.std() == pytest.approx(0.5, rel=0.25)
    assert np.array_equal(rough.texture, other.texture)
    assert not np.array_equal(rough.force, other.force)


def test_draws_cover_the_catalogue_and_keep_their_range():
    drawn = [effects.draw(seed, scale=(0.2, 1.0)).truth["effects"] for seed in range(300)]
    assert all(len(found) == 1 and found[0]["in_catalogue"] for found in drawn)
    families = {name.split(":")[0] for name in effects.EFFECTS if name not in effects.OUTSIDE}
    assert {found[0]["effect"] for found in drawn} == families
    viscous = [found[0]["size"] for found in drawn if found[0]["effect"] == "viscous_friction"]
    assert all(0.2 * 80.0 <= size <= 300.0 for size in viscous)


def test_pairs_and_unknowns_are_drawn_as_asked():
    pairs = [effects.draw(seed, count=2).truth["effects"] for seed in range(60)]
    unknown = [effects.draw(seed, outside=True).truth["effects"] for seed in range(20)]
    assert all(len({effect["effect"] for effect in pair}) == 2 for pair in pairs)
    assert {effects_[0]["effect"] for effects_ in unknown} == set(effects.OUTSIDE)
    json.dumps([pairs, unknown])


@pytest.mark.parametrize(
    ("wish", "count", "known"), [("random", 1, True), ("random random", 2, True), ("outside", 1, False)]
)
def test_the_command_line_draws_too(wish, count, known, tmp_path):
    options = [option for word in wish.split() for option in ("--effect", word)]
    command.main(["--out", str(tmp_path / "case"), "--seed", "3", "--runs", "constant_p7000", *options])
    hidden = json.loads((tmp_path / "case.truth.json").read_text())["effects"]
    assert [effect["in_catalogue"] for effect in hidden] == [known] * count


def test_ends_are_recorded_where_a_machine_differs_there():
    assert "train_ends" in case.runs_for(effects.build(1, [effects.Wish("cushioning")]))
    assert "train_ends" not in case.runs_for(effects.build(1))


@pytest.mark.parametrize("kind", excitation.EXCITATIONS)
def test_every_kind_of_excitation_has_runs_to_fit_and_runs_held_out(kind):
    names = excitation.EXCITATIONS[kind]
    held = [name for name in names if excitation.held_out(name, names)]
    plans = [excitation.programme(name, excitation.run_rng(1, name)) for name in names]
    seconds = [len(plan.voltage) * 1e-3 for plan in plans]
    assert len(set(names)) == len(names)
    assert len({plan.voltage.tobytes() + plan.wanted.tobytes() for plan in plans}) == len(names)  # no run twice
    assert 0.15 < sum(s for name, s in zip(names, seconds, strict=True) if name in held) / sum(seconds) < 0.45
    assert 90.0 < sum(seconds) < 450.0


def test_moves_follow_smooth_ramps_with_pauses_inside_the_stroke():
    built = effects.build(5)
    run = case.make_run(built, "train_moves", step=4e-5)
    wanted = excitation.programme("train_moves", excitation.run_rng(5, "train_moves")).wanted
    speed = np.abs(np.diff(wanted)) * 1000.0
    assert 0.0 < speed.max() < 0.2 * np.pi / 2.0 + 1e-3  # of a raised cosine, beside its mean
    assert np.mean(speed == 0.0) > 0.05
    assert np.abs(run.truth[:, 0]).max() < 0.7
    assert np.median(np.abs(run.truth[:, 0] - wanted)) < 0.05  # a plain loop: late while it moves


@pytest.mark.parametrize(
    ("arguments", "answer"),
    [
        (["--effect", "viscus_friction"], "viscous_friction"),
        (["--effect", "viscous_friction=much"], "N s/m"),
        (["--effect", "viscous_friction=nan"], "N s/m"),
        (["--runs", "nothing"], "train_steps"),
    ],
)
def test_wrong_wishes_are_answered(arguments, answer, tmp_path, capsys):
    with pytest.raises(SystemExit) as stopped:
        command.main(["--out", str(tmp_path / "case"), *arguments])
    assert stopped.value.code == 2
    assert answer in capsys.readouterr().err
    assert not (tmp_path / "case").exists()


@pytest.mark.skipif(
    not RECORDED.is_dir(), reason="no recordings of the rig beside the checkout (PNEUMO_RIG names them)"
)
class TestAgainstTheRecordedRig:
    """Rough agreement: the same machine except for wear, the same sensors, the same layout of the recording."""

    # not those at 0.785 and 0.8 V: their creep speed depends on the worn dead zone
    @pytest.mark.parametrize("name", [name for name in excitation.ALL_RUNS if name.startswith("constant_")][4:])
    def test_constant_runs_end_alike(self, name):
        values = read(RECORDED / name)[1]
        run = case.make_run(effects.build(0, wear=0.0), name, step=4e-5)
        n = len(values["joint_states"])
        travelled = values["joint_states"][-1] - values["joint_states"][0]
        assert len(run.position) == n
        assert run.position[0] == pytest.approx(values["joint_states"][0], abs=1e-3)
        assert run.position[-1] - run.position[0] == pytest.approx(travelled, rel=0.12)
        assert run.pressure_a[-500:].mean() == pytest.approx(values["chamber_a/pressure"][-500:].mean(), rel=0.05)
        assert run.pressure_b[-500:].mean() == pytest.approx(values["chamber_b/pressure"][-500:].mean(), rel=0.05)

    def test_noise_at_rest_is_alike(self):
        values = read(RECORDED / "constant_p7000")[1]
        run = case.make_run(effects.build(0, wear=0.0), "constant_p7000")
        for theirs, ours in ((values["joint_states"], run.position), (values["chamber_a/pressure"], run.pressure_a)):
            spread = [np.diff(signal[5000:]).std() for signal in (theirs, ours)]
            assert spread[0] == pytest.approx(spread[1], rel=0.05)

    def test_bags_have_the_same_topics_and_bytes_per_message(self, tmp_path):
        list(case.write_case(effects.build(0), tmp_path / "case", ["constant_p7000"]))
        shapes = []
        for folder in (RECORDED / "constant_p7000", tmp_path / "case" / "constant_p7000"):
            with AnyReader([folder]) as reader:
                shapes.append({(c.topic.lstrip("/"), c.msgtype, len(raw)) for c, _, raw in reader.messages()})
        assert shapes[0] == shapes[1]
