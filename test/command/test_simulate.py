"""`pneumo simulate`: recordings that contain the motion of the model."""

import json
from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.command.main import main
from pneumo_ros.plant import load_model, save_model
from pneumo_ros.records import read_recording, write_recording

pytestmark = pytest.mark.usefixtures("_in_folder")


@pytest.fixture
def _in_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_the_recording_is_what_the_model_does() -> None:
    assert main(["simulate", "--input", "step:2.5@0.1", "--seconds", "0.5", "--out", "run", "--quiet"]) == 0
    recording = read_recording("run")
    model = load_model("axis")
    volts = np.where(np.arange(500) >= 100, 2.5, 0.0)
    states = np.vstack([model.state(), model.simulate(volts, model.state())])
    for signal, column in (("position", 0), ("velocity", 1), ("pressure_a", 2), ("pressure_b", 3)):
        np.testing.assert_array_equal(getattr(recording, signal), states[:, column])
    np.testing.assert_array_equal(recording.effort, model.effort(states))
    np.testing.assert_array_equal(recording.voltage[:-1], volts)
    assert recording.sample_time == pytest.approx(1e-3)
    assert recording.description["model"] == model.as_dict()


def test_a_replay_repeats_its_recording() -> None:
    assert main(["simulate", "--input", "sine:3,1", "--seconds", "1", "--out", "first", "--quiet"]) == 0
    assert main(["simulate", "--input", "first", "--out", "second", "--quiet"]) == 0
    first, second = read_recording("first"), read_recording("second")
    # The first state is estimated from the recording; the rest is the same arithmetic.
    np.testing.assert_allclose(second.position, first.position, atol=1e-7)
    np.testing.assert_array_equal(second.voltage, first.voltage)


def test_seconds_shorten_a_replay() -> None:
    assert main(["simulate", "--input", "constant:3", "--seconds", "0.5", "--out", "first", "--quiet"]) == 0
    assert main(["simulate", "--input", "first", "--seconds", "0.2", "--out", "second", "--quiet"]) == 0
    assert read_recording("second").duration == pytest.approx(0.2)


def test_rate_and_position() -> None:
    arguments = ["--input", "constant:0", "--seconds", "1", "--rate", "250", "--position", "-0.4", "--out", "run"]
    assert main(["simulate", *arguments, "--quiet"]) == 0
    recording = read_recording("run")
    assert len(recording) == 251
    assert recording.position[0] == -0.4


def test_json_repeats_the_end(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "--input", "constant:2", "--seconds", "0.1", "--out", "run", "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["recording"] == "run"
    assert data["samples"] == 101
    assert data["final_state"]["y"] == read_recording("run").position[-1]


def test_an_effect_of_ones_own(capsys: pytest.CaptureFixture[str]) -> None:
    """The file and the machine file that the README shows."""
    readme = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
    Path("my_effects.py").write_text(readme.split("```python\n")[1].split("```")[0])
    axis = Path(load_model.__globals__["__file__"]).parents[1].joinpath("config", "axis.yaml").read_text()
    machine = axis.replace("end_stop]", "end_stop, seal_leak]") + "    seal_leak: {conductance: 1.0e-7}\n"
    Path("leaky.yaml").write_text(machine)
    common = ["--input", "sine:3,0.5", "--seconds", "1", "--quiet", "--out"]
    assert main(["simulate", *common, "leaky_run", "--model", "leaky.yaml", "--effects", "my_effects.py"]) == 0
    assert main(["simulate", *common, "tight_run"]) == 0
    gap = read_recording("leaky_run").pressure_a - read_recording("tight_run").pressure_a
    assert abs(gap).max() > 100.0
    assert main(["effects", "seal_leak", "--effects", "my_effects.py"]) == 0
    assert "leak = conductance * (p_a - p_b)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (["--input", "constant:1", "--seconds", "-1", "--out", "run"], 2, "above 0"),
        (["--input", "constant:1", "--rate", "nan", "--out", "run"], 2, "above 0"),
        (["--input", "constant:1", "--position", "3", "--out", "run"], 2, "stroke"),
        (["--input", "constant:1", "--out", "."], 2, "exists"),
        (["--input", "constant:1", "--out", "no/run"], 2, "mkdir -p no"),
        (["--input", "constant:1"], 2, "--out"),
        (["--input", "constant:1", "--out", "run", "--model", "axsi"], 3, "axis"),
        (["--input", "drive.csv", "--out", "run"], 3, "drive.csv"),
        (["--input", "empty", "--out", "run"], 3, "empty"),
    ],
)
def test_what_is_refused(arguments: list[str], code: int, sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("empty").mkdir()
    assert main(["simulate", *arguments]) == code
    error = capsys.readouterr().err
    assert sentence in error
    assert error.count("\n") == 1
    assert not Path("run").exists()


def test_a_replay_says_how_long_it_can_be(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "--input", "constant:1", "--seconds", "0.5", "--out", "first", "--quiet"]) == 0
    assert main(["simulate", "--input", "first", "--seconds", "2", "--out", "run"]) == 2
    assert "lasts 0.5 s" in capsys.readouterr().err


def force_driven_files() -> None:
    """`sealed.yaml`, a rod whose friction follows the pressures, and `pushed`, a recording with them."""
    emps = load_model("emps")
    save_model(emps.with_effects([*emps.effects, "pressure_dependent_friction"]), "sealed.yaml")
    time = np.arange(2000) * 1e-3
    signals = {"position": 0.02 * np.sin(time), "effort": 300.0 * np.sin(6.0 * time)}
    pressures = {"pressure_a": 4e5 + 1e5 * np.sin(5.0 * time), "pressure_b": 3e5 + 1e5 * np.cos(5.0 * time)}
    write_recording("pushed", time=time, **signals, **pressures)


def test_a_replay_takes_measured_pressures_and_records_them() -> None:
    force_driven_files()
    assert main(["simulate", "--input", "pushed", "--model", "sealed.yaml", "--out", "second", "--quiet"]) == 0
    first, second = read_recording("pushed"), read_recording("second")
    for name in ("effort", "pressure_a", "pressure_b"):
        half = np.abs(np.diff(getattr(first, name))).max()  # inputs are those of the first tenth of a sample
        np.testing.assert_allclose(getattr(second, name), getattr(first, name), atol=half)
    assert main(["simulate", "--input", "second", "--model", "sealed.yaml", "--out", "third", "--quiet"]) == 0
    np.testing.assert_allclose(read_recording("third").position, second.position, atol=2e-4)


def test_a_formula_has_no_pressures(capsys: pytest.CaptureFixture[str]) -> None:
    force_driven_files()
    assert main(["simulate", "--input", "sine:300,1", "--model", "sealed.yaml", "--out", "run", "--quiet"]) == 2
    said = capsys.readouterr().err
    assert "effects of 'sealed' read measured signals (p_a, p_b); give a recording that has them as the input" in said
    assert not Path("run").exists()


def test_sensor_effects_are_in_the_recording(tmp_path: Path) -> None:
    """An offset of a pressure sensor belongs to the machine file: a recording of it has to hold it."""
    import pneumo_ros as pn

    axis = pn.load_model("axis")
    off = axis.with_effects(
        [*axis.effects, "pressure_sensor_offset"],
        {"pressure_sensor_offset.offset_a": 2e4, "pressure_sensor_offset.offset_b": 0.0},
    )
    right, wrong = (pn.simulate(model, "sine:3,1", seconds=1) for model in (axis, off))
    assert wrong.pressure_a - right.pressure_a == pytest.approx(np.full(1001, 2e4))
    assert wrong.pressure_b == pytest.approx(right.pressure_b)
    assert pn.compare(wrong, off).explained
    assert not pn.compare(wrong, axis).explained


def test_noise_is_of_the_size_and_the_seed_that_were_asked() -> None:
    common = ["simulate", "--input", "sine:3,0.5", "--seconds", "5", "--quiet", "--out"]
    noise = ["--noise", "position=5e-6", "--noise", "pressure_a=200,pressure_b=100"]
    assert main([*common, "clean"]) == 0
    for out, seed in (("one", "1"), ("same", "1"), ("other", "2")):
        assert main([*common, out, *noise, "--seed", seed]) == 0
    clean, one, same, other = (read_recording(name) for name in ("clean", "one", "same", "other"))
    for signal, size in (("position", 5e-6), ("pressure_a", 200.0), ("pressure_b", 100.0)):
        drawn = getattr(one, signal) - getattr(clean, signal)
        assert np.std(drawn) == pytest.approx(size, rel=0.1)  # 5001 samples: 1 % of its standard error
        np.testing.assert_array_equal(getattr(same, signal), getattr(one, signal))
        assert np.std(getattr(other, signal) - getattr(one, signal)) == pytest.approx(size * 2**0.5, rel=0.1)
    np.testing.assert_array_equal(one.voltage, clean.voltage)
    assert one.velocity is None, "a rig seldom measures it"
    assert one.effort is None
    assert (one.description["seed"], other.description["seed"]) == (1, 2)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--noise", "5e-6"], "names no signal"),
        (["--noise", "presure_a=200"], "pressure_a"),
        (["--noise", "position=small"], "a standard deviation in m"),
        (["--noise", "position=-1"], "at least 0"),
        (["--noise", "position=nan"], "at least 0"),
        (["--noise", "position=1e-6,position=2e-6"], "twice"),
        (["--seed", "3"], "goes with --noise"),
        (["--noise", "position=1e-6", "--seed", "-3"], "at least 0"),
    ],
)
def test_noise_that_cannot_be_is_named(options: list[str], says: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "--input", "constant:1", "--seconds", "0.1", "--out", "run", *options]) == 2
    assert says in capsys.readouterr().err
    assert not Path("run").exists()
