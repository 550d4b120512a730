"""The wiring of a rig, guessed from a recording, and the file that holds it."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pneumo_ros as pn
from pneumo_ros.command.main import main
from pneumo_ros.command.rig_file import read_rig
from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.reading.rig_guess import guess_rig
from pneumo_ros.runs.run import run_for

NOISE = {"position": 5e-6, "pressure_a": 300.0, "pressure_b": 300.0}  # m, Pa
STROKE = 0.4


@pytest.fixture(scope="module")
def truth() -> pn.Model:
    """A short machine, so that the zero of an encoder shows in the volumes of its chambers."""
    axis = pn.load_model("axis")
    half = 0.5 * STROKE
    return axis.with_parameters(
        {
            "piston.stroke": STROKE,
            "chambers.volume_a": axis["piston.area_a"] * half + 4e-5,
            "chambers.volume_b": axis["piston.area_b"] * half + 4e-5,
        }
    )


@pytest.fixture(scope="module")
def right(truth: pn.Model) -> pn.Recording:
    return pn.simulate(truth, "sine:3,0.7", seconds=8, noise=NOISE, name="strokes")


@pytest.fixture(scope="module")
def rough(truth: pn.Model) -> pn.Model:
    """The machine as a data sheet knows it."""
    off = {"lugre_friction.coulomb_friction": 0.85, "arctan_flow.filling_coefficient": 1.15, "piston.mass": 1.2}
    return truth.with_parameters({name: share * truth[name] for name, share in off.items()})


def wired(right: pn.Recording) -> pn.Recording:
    """In mm from the left end, gauge bar, chambers swapped, a valve of 0 to 10 V."""
    assert right.voltage is not None
    assert right.command is not None
    return replace(
        right, position=1e3 * (right.position + 0.5 * STROKE), pressure_a=(right.pressure_b - 1e5) / 1e5,
        pressure_b=(right.pressure_a - 1e5) / 1e5, voltage=right.voltage + 5.0, command=right.command + 5.0,
    )  # fmt: skip


def test_a_right_recording_needs_no_word(right: pn.Recording, rough: pn.Model) -> None:
    found = guess_rig(right, rough)
    assert found.best.words == ()
    assert found.certain


def test_everything_wrong_at_once_is_found(right: pn.Recording, rough: pn.Model) -> None:
    found = guess_rig(wired(right), rough)
    assert {*found.best.words} == {"bar", "mm", "gauge", "swapped-chambers", "zero=200mm", "closed=5V"}
    assert found.certain


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda r: {"voltage": -r.voltage, "command": -r.command}, ("reversed-voltage",)),
        (lambda r: {"position": -r.position}, ("reversed-position",)),
        (lambda r: {"pressure_a": r.pressure_b, "pressure_b": r.pressure_a}, ("swapped-chambers",)),
    ],
)
def test_one_wrong_plug_is_named(right: pn.Recording, rough: pn.Model, change: Any, words: tuple[str, ...]) -> None:
    assert guess_rig(replace(right, **change(right)), rough).best.words == words


def test_a_machine_that_turns_is_in_degrees() -> None:
    """Its angle was taken for mm once."""
    vane = pn.load_model("vane")
    right = pn.simulate(vane, "sine:2,0.7", seconds=6, noise=NOISE | {"position": 1e-4}, name="swings")
    turned = replace(right, position=np.degrees(right.position + 0.5 * vane["piston.stroke"]))
    words = guess_rig(turned, vane).best.words
    assert words == ("deg", f"zero={0.5 * vane['piston.stroke']:g}rad")


def test_a_single_window_of_motion_is_no_perfect_fit(truth: pn.Model) -> None:
    """The scale of friction takes all of its residual: the momentum, 4e-16 N, once decided alone."""
    short = pn.simulate(truth, "sine:3,0.7", seconds=0.29, noise=NOISE, name="short")
    short = replace(short, position=short.position - 0.05)  # else an encoder's zero at an end makes sense
    momentum = equation_residuals(truth, run_for(short, truth))["momentum"]
    assert len(momentum.value) == 1
    found = guess_rig(short, truth, known=(), closed=())
    assert min(one.residuals["momentum"] for one in found.ranked) == pytest.approx(float(momentum.noise[0]), rel=0.1)


def test_what_tells_nothing_is_refused(truth: pn.Model, right: pn.Recording) -> None:
    still = replace(right, position=np.zeros(len(right)))
    with pytest.raises(DataError, match="the piston moves 0 mm; record a run that moves it both ways"):
        guess_rig(still, truth)
    with pytest.raises(DataError, match="takes a valve command, a position and both pressures"):
        guess_rig(replace(right, voltage=None), truth)


def test_pressures_of_oil_are_named(truth: pn.Model, right: pn.Recording) -> None:
    assert right.pressure_a is not None
    assert right.pressure_b is not None
    oil = replace(right, pressure_a=20.0 * right.pressure_a, pressure_b=20.0 * right.pressure_b)
    with pytest.raises(DataError, match=r"more than a pneumatic axis has.*--read-as no-command"):
        guess_rig(oil, truth)


def test_the_verb_writes_a_file_that_other_verbs_take(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, right: pn.Recording, rough: pn.Model, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    pn.save(wired(right), "strokes")
    pn.save_model(rough, "my.yaml")
    assert (
        main(["rig", "check", "strokes", "--model", "my.yaml", "--out", "rig.yaml", "--json", "rig.json", "--quiet"])
        == 0
    )
    said = capsys.readouterr().out
    assert "strokes was recorded as: bar,mm,gauge,swapped-chambers,zero=200mm,closed=5V." in said
    assert json.loads(Path("rig.json").read_text())["certain"] is True
    assert main(["compare", "strokes", "--rig", "rig.yaml", "--refit", "--quiet", "--json", "out.json"]) == 0
    assert "# limits: -200mm..200mm" in Path("rig.yaml").read_text()  # the stroke is 0.4 m
    with Path("rig.yaml").open("a") as file:
        file.write("  limits: -30deg..30deg\n")
    assert main(["compare", "strokes", "--rig", "rig.yaml"]) == 2
    assert "limits are angles, -30deg..30deg, and my moves along a line" in capsys.readouterr().err
    Path("rig.yaml").write_text(Path("rig.yaml").read_text().replace("-30deg..30deg", "-30mm..30mm"))
    compared = json.loads(Path("out.json").read_text())
    assert compared["runs"][0]["error"]["position_m"]["rms"] < 5e-4  # m; 0.2 m off without its zero
    again = pn.read("strokes", rig="rig.yaml")
    np.testing.assert_allclose(again.position, right.position, atol=1e-12)
    np.testing.assert_allclose(again.pressure_a, right.pressure_a, rtol=1e-12)
    with pytest.raises(UsageError, match="leave read_as, namespace and joint out"):
        pn.read("strokes", rig="rig.yaml", read_as="bar")
    assert main(["rig", "check", "strokes", "--model", "my.yaml", "--out", "rig.yaml"]) == 2
    assert "exists and is not overwritten" in capsys.readouterr().err
    assert main(["compare", "strokes", "--rig", "rig.yaml", "--read-as", "kPa"]) == 2
    assert "leave one out" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("rig: 3", "has no section 'rig'; type: pneumo rig check"),
        ("rig: {machne: axis}", "did you mean machine"),
        ("rig: {read_as: 5}", "read_as is 5; it takes a text"),
        ("rig: {read_as: barr}", "did you mean bar"),
    ],
)
def test_a_bad_rig_file_is_named(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "rig.yaml").write_text(text)
    with pytest.raises(UsageError, match=words):
        read_rig(str(tmp_path / "rig.yaml"))
    with pytest.raises(DataError, match="cannot be read"):
        read_rig(str(tmp_path / "none.yaml"))
