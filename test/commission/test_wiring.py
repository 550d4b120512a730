"""Mirror images: a piston moves alike in both, and only a fit of the machine tells them apart."""

from dataclasses import replace
from pathlib import Path

import pytest

import pneumo_ros as pn
from pneumo_ros.command.main import main
from pneumo_ros.command.verb.rig import text
from pneumo_ros.commission import wiring
from pneumo_ros.commission.wiring import fitted
from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.reading.rig_guess import Guess, Hypothesis, guess_rig

SHEET = Wishes(supply="6barg", mass="2", bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min")
NOISE = {"position": 1e-5, "pressure_a": 300.0, "pressure_b": 300.0}
MIRRORED = ("swapped-chambers", "reversed-position", "reversed-voltage")


@pytest.fixture(scope="module")
def sheet() -> pn.Model:
    return design(SHEET, load_shelf([])).model


@pytest.fixture(scope="module")
def strokes(sheet: pn.Model) -> pn.Recording:
    """Full strokes both ways of a machine with a viscous friction that no data sheet mentions."""
    real = sheet.with_effects([*sheet.effects, "viscous_friction"], {"viscous_friction.coefficient": 90.0})
    return pn.simulate(real, "sine:2.5,1", seconds=5.0, noise=NOISE, name="strokes")


def mirrored(one: pn.Recording) -> pn.Recording:
    """As a rig with everything the wrong way round records it."""
    assert one.voltage is not None
    assert one.command is not None
    return replace(
        one, position=-one.position, pressure_a=one.pressure_b, pressure_b=one.pressure_a, voltage=-one.voltage,
        command=-one.command,
    )  # fmt: skip


def test_a_fit_tells_mirror_images_apart(sheet: pn.Model, strokes: pn.Recording) -> None:
    for recording, words in ((strokes, ()), (mirrored(strokes), MIRRORED)):
        found = guess_rig(recording, sheet)
        assert {one.words for one in found.alike} == {(), MIRRORED}
        assert not found.certain
        judged = fitted(found, [recording], sheet)
        assert judged.best.words == words
        assert judged.certain
        assert {one.words for one in judged.ranked} == {one.words for one in found.ranked}


def test_other_valves_are_tried_only_where_the_stated_one_explains_nothing(
    sheet: pn.Model, strokes: pn.Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A machine as its file says, and one with a friction that the file lacks."""
    tried: list[int] = []
    fit = wiring._fit
    monkeypatch.setattr(wiring, "_fit", lambda fitter, number: (tried.append(number), fit(fitter, number))[1])
    alike = Guess((Hypothesis(MIRRORED, {"momentum": 1.0}), Hypothesis((), {"momentum": 1.1})), None)
    healthy = pn.simulate(sheet, "sine:2.5,1", seconds=3.0, noise=NOISE, name="healthy")
    for recording, valves in ((healthy, {0}), (strokes, {*range(wiring.VALVES)})):
        tried.clear()
        judged = fitted(alike, [recording], sheet)
        assert judged.best.words == ()
        assert judged.decided
        assert set(tried) == valves


def test_the_verb_is_sure_of_full_strokes(
    sheet: pn.Model, strokes: pn.Recording, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pn.save(strokes, tmp_path / "strokes")
    pn.save_model(sheet, tmp_path / "my.yaml")
    assert main(["rig", "check", str(tmp_path / "strokes"), "--model", str(tmp_path / "my.yaml")]) == 0
    said = capsys.readouterr().out
    assert "strokes is as 'my' needs it" in said
    assert "nearly as well" not in said


def test_what_no_fit_tells_apart_is_named() -> None:
    alike = Guess((Hypothesis(("zero=5mm",), {"momentum": 1.0}), Hypothesis(MIRRORED, {"momentum": 1.1})), None)
    assert not alike.certain
    assert "They differ in reversed-position,reversed-voltage,swapped-chambers,zero=5mm." in text(alike, "a", "b")
