"""`import pneumo_ros as pn`: what it offers, on recordings that it simulated itself."""

import inspect
import json
import subprocess
import sys
from dataclasses import FrozenInstanceError, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pneumo_ros as pn
from pneumo_ros.errors import DataError, UsageError

NOISE = {"position": 5e-6, "pressure_a": 200.0, "pressure_b": 200.0}  # m, Pa, Pa
FUNCTIONS = [name for name in pn.__all__ if inspect.isfunction(getattr(pn, name))]
VISCOUS = 120.0  # N s/m


@pytest.fixture(scope="module")
def rig() -> pn.Model:
    """The default machine with a friction that it does not know."""
    axis = pn.load_model("axis")
    return axis.with_effects([*axis.effects, "viscous_friction"], {"viscous_friction.coefficient": VISCOUS})


@pytest.fixture(scope="module")
def runs(rig: pn.Model) -> dict[str, pn.Recording]:
    drives = {"slow": "sine:3,0.5", "fast": "sine:5,0.9", "hold": "sine:4,0.7"}
    return {
        name: pn.simulate(rig, drive, seconds=4, noise=NOISE, seed=k, name=name)
        for k, (name, drive) in enumerate(drives.items())
    }


@pytest.fixture(scope="module")
def wrong(runs: dict[str, pn.Recording]) -> Any:
    """The machine without its viscous friction, compared."""
    return pn.compare([runs["slow"], runs["fast"]])


@pytest.fixture(scope="module")
def diagnosis(runs: dict[str, pn.Recording]) -> Any:
    return pn.diagnose([runs["slow"], runs["fast"]], runs["hold"])


# --- promises ---------------------------------------------------------------------------------------------------------


def test_it_offers_the_verbs_and_names_near_ones() -> None:
    assert {"read", "import_table", "simulate", "compare", "identify", "diagnose", "add", "parts", "Effect"} <= {
        *dir(pn)
    }
    with pytest.raises(AttributeError, match="unknown name 'diagnos'; did you mean diagnose"):
        pn.diagnos  # noqa: B018


def test_rooms_do_not_take_the_names_of_functions() -> None:
    from pneumo_ros.compare.verdicts import SignalError
    from pneumo_ros.parts.shelf import Shelf

    assert inspect.isclass(SignalError)
    assert inspect.isclass(Shelf)
    assert all(inspect.isfunction(getattr(pn, name)) for name in ("compare", "diagnose", "identify", "parts"))


def test_importing_it_loads_nothing_slow() -> None:
    program = "import sys, pneumo_ros; print(sorted({'numpy', 'numba', 'yaml', 'pandas'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True).stdout.strip() == "[]"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_argument_is_in_the_docstring_or_of_another_function(name: str) -> None:
    function = getattr(pn, name)
    words = inspect.getdoc(function) or ""
    for borrowed in ("compare", "diagnose"):
        if f"as for `{borrowed}`" in words:
            words += inspect.getdoc(getattr(pn, borrowed)) or ""
    common = {"progress"}  # the same everywhere, said in docs/python.md
    for argument in inspect.signature(function).parameters:
        assert argument in common or f"`{argument}`" in words or argument in words.split(), f"{name}: {argument}"
    assert "Raises" in words or "Error" in words, name


@pytest.mark.parametrize("name", FUNCTIONS)
def test_no_misspelt_keyword_is_swallowed(name: str) -> None:
    with pytest.raises(TypeError, match="modle"):
        getattr(pn, name)(modle="axis")


def test_results_are_frozen(wrong: Any) -> None:
    with pytest.raises(FrozenInstanceError):
        wrong.model = None


# --- recordings -------------------------------------------------------------------------------------------------------


def test_a_simulation_saved_and_read_is_the_same(tmp_path: Path, runs: dict[str, pn.Recording]) -> None:
    pn.save(runs["slow"], tmp_path / "slow")
    again = pn.read(tmp_path / "slow")
    assert {*again.signals} == {*runs["slow"].signals}
    for name, values in runs["slow"].signals.items():
        assert again.signals[name] == pytest.approx(values, rel=1e-12), name
    assert str(again).startswith("slow: 4 s at 1000 Hz, 4001 samples of position, ")


def test_voltages_and_recordings_drive_as_formulas_do(rig: pn.Model) -> None:
    formula = pn.simulate(rig, "sine:3,0.5", seconds=2)
    assert formula.voltage is not None
    volts = pn.simulate(rig, formula.voltage[:-1], seconds=2)
    again = pn.simulate(rig, formula, seconds=2)
    assert volts.position == pytest.approx(formula.position, abs=1e-15)
    assert again.position == pytest.approx(formula.position, abs=1e-12)
    assert float(np.ptp(formula.position)) > 0.05


def test_a_data_frame_holds_the_signals_over_time(runs: dict[str, pn.Recording]) -> None:
    pytest.importorskip("pandas")
    frame = runs["slow"].to_dataframe()
    assert list(frame.columns) == ["position", "pressure_a", "pressure_b", "voltage"]
    assert frame.index.name == "time"
    assert frame["position"].to_numpy() == pytest.approx(runs["slow"].position)


def test_a_table_becomes_a_recording_by_a_guess_or_by_a_map(tmp_path: Path, runs: dict[str, pn.Recording]) -> None:
    one = runs["slow"]
    rows = np.column_stack([one.time, 1e3 * one.position, one.pressure_a / 1e5, one.pressure_b / 1e5, one.voltage])
    head = "time [s],position [mm],pressure_a [bar],pressure_b [bar],voltage [V]"
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header=head, comments="")
    guessed = pn.import_table(tmp_path / "run.csv")
    assert guessed.position == pytest.approx(one.position, abs=1e-9)
    assert guessed.pressure_a == pytest.approx(one.pressure_a, rel=1e-6)
    assert not (tmp_path / "bag").exists()
    assert guessed.description is not None
    again = pn.import_table(tmp_path / "run.csv", guessed.description["map"], out=tmp_path / "bag")
    assert pn.read(tmp_path / "bag").position == pytest.approx(again.position)
    np.savetxt(tmp_path / "bare.csv", rows, delimiter=",", header="a,b,c,d,e", comments="")
    with pytest.raises(UsageError, match="complete this map"):
        pn.import_table(tmp_path / "bare.csv")


def test_bad_input_is_named() -> None:
    with pytest.raises(DataError, match="nowhere"):
        pn.read("nowhere")
    with pytest.raises(UsageError, match="no recording is given"):
        pn.compare([])
    with pytest.raises(UsageError, match="a recording is given by its path"):
        pn.compare(3)  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="did you mean pressure_a"):
        pn.simulate("axis", "constant:1", seconds=0.1, noise={"presure_a": 1.0})
    with pytest.raises(UsageError, match="seconds is -1"):
        pn.simulate("axis", "constant:1", seconds=-1)
    with pytest.raises(UsageError, match="did you mean valve"):
        pn.parts(kind="valv")


def test_a_folder_of_recordings_is_read_one_by_one(tmp_path: Path, runs: dict[str, pn.Recording]) -> None:
    for name in ("slow", "fast"):
        pn.save(runs[name], tmp_path / name)
    with pytest.raises(UsageError, match="holds 2 recordings; read one, such as"):
        pn.read(tmp_path)
    found = pn.compare(tmp_path)
    assert [row["run"] for row in found.rows()[::3]] == ["fast", "slow"]


# --- results ----------------------------------------------------------------------------------------------------------


def test_compare_tells_the_true_machine_from_the_wrong_one(
    rig: pn.Model, runs: dict[str, pn.Recording], wrong: Any
) -> None:
    right = pn.compare(runs["hold"], rig)
    assert right.explained
    assert not wrong.explained
    assert max(row["ratio_to_noise"] for row in right.rows()) < 1.2 < min(row["ratio_to_noise"] for row in wrong.rows())
    assert "momentum" in str(wrong)
    assert "FAILS" in str(wrong)


def test_fitting_first_moves_the_model(runs: dict[str, pn.Recording], rig: pn.Model) -> None:
    off = rig.with_parameters({"viscous_friction.coefficient": 0.5 * VISCOUS})
    found = pn.compare(runs["hold"], off, fit=runs["slow"])
    assert found.model["viscous_friction.coefficient"] == pytest.approx(VISCOUS, rel=0.02)
    assert found.as_dict()["refit"]["runs"] == ["slow"]
    assert max(row["ratio_to_noise"] for row in found.rows()) < 2.0


def test_the_json_is_that_of_the_command(wrong: Any, diagnosis: Any) -> None:
    assert json.loads(json.dumps(wrong.as_dict(), allow_nan=False))["schema_version"] == 1
    assert {"model", "horizon_s", "runs", "equations"} <= {*wrong.as_dict()}
    said = json.loads(json.dumps(diagnosis.as_dict(), allow_nan=False))
    assert {"verdict", "failing", "added", "candidates", "holdout", "unexplained", "suggested_experiment"} <= {*said}
    assert said["cannot_say"] == diagnosis.as_dict()["cannot_say"]


def test_diagnose_finds_the_effect_and_gives_the_machine(diagnosis: Any, runs: dict[str, pn.Recording]) -> None:
    assert diagnosis.verdict == "effects_found"
    assert [one.effect for one in diagnosis.added] == ["viscous_friction"]
    value = diagnosis.added[0].parameters["coefficient"]
    assert value.value == pytest.approx(VISCOUS, abs=3.0 * value.std)
    assert value.unit == "N s/m"
    assert diagnosis.failing == ("momentum",)
    assert diagnosis.model.effects[-1] == "viscous_friction"
    assert "lacks viscous_friction" in diagnosis.headline
    after = pn.compare(runs["hold"], diagnosis.model)
    assert all(one["explained_by_noise"] for one in after.as_dict()["equations"].values())


def test_a_diagnosis_refuses_what_it_cannot_judge(runs: dict[str, pn.Recording]) -> None:
    with pytest.raises(UsageError, match="is a copy of"):
        pn.diagnose(runs["slow"], replace(runs["slow"], name="other"))
    with pytest.raises(UsageError, match="within is 0"):
        pn.diagnose(runs["slow"], runs["hold"], within=0.0)


def test_add_fits_the_named_effect(runs: dict[str, pn.Recording]) -> None:
    found = pn.add("viscous_friction", runs["slow"], holdout=runs["hold"])
    assert found.errors[2] < 0.2 * found.errors[1]
    assert found.rows()[0]["parameter"] == "coefficient"
    assert found.rows()[0]["low"] < VISCOUS < found.rows()[0]["high"]
    assert found.model.effects[-1] == "viscous_friction"
    with pytest.raises(UsageError, match="did you mean viscous_friction"):
        pn.add("viscos_friction", runs["slow"])


def test_identify_gives_parameters_with_intervals() -> None:
    axis = pn.load_model("axis")
    both = [(sign, volts) for volts in (1.2, 1.8, 2.6) for sign in (1, -1)]
    campaign = [
        pn.simulate(
            axis, f"step:{sign * volts}@0.5", seconds=4, position=-0.5 * sign, noise=NOISE, seed=k, name=f"run_{k}"
        )
        for k, (sign, volts) in enumerate(both)
    ]
    found = pn.identify(campaign, axis.with_parameters({"lugre_friction.coulomb_friction": 60.0}))
    coulomb = next(row for row in found.rows() if row["parameter"] == "lugre_friction.coulomb_friction")
    assert coulomb["before"] == 60.0
    assert coulomb["value"] == pytest.approx(axis["lugre_friction.coulomb_friction"], rel=0.02)
    assert coulomb["low"] < coulomb["value"] < coulomb["high"]
    assert "coulomb_friction" in str(found)


@pytest.mark.parametrize("library", ["matplotlib", "plotly"])
def test_every_chart_is_drawn_by_one_call(library: Any, wrong: Any, diagnosis: Any) -> None:
    pytest.importorskip(library)
    kind = {"matplotlib": "matplotlib.figure", "plotly": "plotly.graph_objs"}[library]
    for result in (wrong, diagnosis):
        assert type(result.plot(library=library)).__module__.startswith(kind)
        for name in list(result.charts)[:12]:
            assert type(result.plot(name, library)).__module__.startswith(kind), name
    with pytest.raises(UsageError, match="did you mean waterfall"):
        diagnosis.plot("waterfal")
    with pytest.raises(UsageError, match="it takes 'matplotlib' or 'plotly'"):
        diagnosis.plot(library="bokeh")


def test_a_waterfall_of_plotly_holds_the_errors(diagnosis: Any) -> None:
    pytest.importorskip("plotly")
    drawn = {round(float(x), 6) for one in diagnosis.plot(library="plotly").data for x in one.x if x is not None}
    assert {round(error, 6) for _, error in diagnosis.outcome.waterfall} <= drawn


def test_a_notebook_shows_verdict_waterfall_and_table(diagnosis: Any, wrong: Any) -> None:
    shown = diagnosis._repr_html_()
    assert diagnosis.headline.replace("'", "&#x27;") in shown
    assert shown.count("<tr>") >= 2 + len(diagnosis.outcome.waterfall) + 1
    assert "<script" not in shown
    assert "slow" in wrong._repr_html_()


def test_tables_are_data_frames(diagnosis: Any, wrong: Any) -> None:
    pytest.importorskip("pandas")
    assert diagnosis.to_dataframe()["effect"].iloc[0] == "viscous_friction"
    assert wrong.to_dataframe().shape == (6, 8)


def test_the_page_is_that_of_the_command(tmp_path: Path, diagnosis: Any) -> None:
    pytest.importorskip("plotly")
    diagnosis.report(tmp_path / "page.html")
    text = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "called from Python" in text
    assert text.count("viscous_friction") > 5


# --- effects of one's own ---------------------------------------------------------------------------------------------


class CatchPoint(pn.Effect):
    """A force that holds the piston near a place. Source: this test."""

    depth = pn.Parameter(20.0, "N", "greatest force", low=0.0, neutral=0.0)

    def equations(y: Any, depth: Any) -> Any:  # type: ignore[override,misc]  # noqa: N805
        force = -depth * y / (0.02 + y * y / 0.02)
        return force  # noqa: RET504


def test_an_effect_may_be_a_class(rig: pn.Model) -> None:
    own = pn.load_model("axis", effects_files=[CatchPoint])
    held = own.with_effects([*own.effects, "catch_point"])
    one, other = (pn.simulate(model, "sine:3,0.5", seconds=1).position for model in (held, own))
    assert float(np.max(np.abs(one - other))) > 1e-4
    with pytest.raises(UsageError, match="class ViscousFriction defines viscous_friction, which is already taken"):
        pn.load_model("axis", effects_files=[rig.library.find("viscous_friction")])
