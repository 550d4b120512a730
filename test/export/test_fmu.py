"""A functional mock-up unit is valid, equals the kernel, and refuses what the machine file would refuse."""

import subprocess
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from export.compiling import COMPILER, STRICT, largest_difference, needs_compiler
from export.mockup import VERSIONS, fmpy, running, written
from plant.catalogue import everything

from pneumo_ros.export import Exported, fmu_archive
from pneumo_ros.plant import load_model

pytestmark = needs_compiler
both = pytest.mark.parametrize("version", VERSIONS)
LEVELS = np.repeat(np.random.default_rng(2).choice([-6.0, -3.0, -1.2, 0.0, 1.2, 3.0, 6.0], 25), 400)


@pytest.mark.parametrize(("name", "version"), [("axis", 2), ("axis", 3), ("emps", 2), ("every effect", 3)])
def test_fmpy_finds_no_problem(name: str, version: int, tmp_path: Path) -> None:
    from fmpy.validation import validate_fmu

    model = everything() if name == "every effect" else load_model(name)
    assert validate_fmu(str(written(model, version, tmp_path))) == []


@both
@pytest.mark.parametrize("name", ["axis", "emps"])
def test_ten_seconds_equal_those_of_the_kernel(name: str, version: int, tmp_path: Path) -> None:
    model = load_model(name)
    held = LEVELS * (20.0 if model.force_driven else 1.0)
    with running(model, version, tmp_path) as fmu:
        fmu.start(y=0.1, v=0.2)
        found = fmu.run(held, *model.states, "effort")
    states = model.simulate(held, model.state(y=0.1, v=0.2))
    wanted = np.column_stack([states, model.outputs(states, held)["effort"]])
    assert largest_difference(wanted, found) < 1e-9


@both
def test_parameters_are_those_of_the_machine_file_with_unit_and_range(version: int, tmp_path: Path) -> None:
    model = load_model("axis")
    described = fmpy.read_model_description(str(written(model, version, tmp_path)))
    variables = {variable.name: variable for variable in described.modelVariables}
    for dotted, value in model.parameters.items():
        specification, variable = model.specification(dotted), variables[dotted]
        assert (float(variable.start), variable.unit) == (value, specification.unit)
        assert float(variable.min or "-inf") == specification.low
        assert float(variable.max or "inf") == specification.high


@both
def test_another_parameter_acts_as_in_the_kernel_before_and_during_a_run(version: int, tmp_path: Path) -> None:
    model = load_model("axis")
    heavy = model.with_parameters({"piston.mass": 12.0, "air.atmospheric_pressure": 9e4})
    lighter = heavy.with_parameters({"piston.mass": 8.0})
    with running(model, version, tmp_path) as fmu:
        fmu.start(piston__mass=12.0, air__atmospheric_pressure=9e4)
        first = fmu.run(LEVELS[400:900], *model.states)
        fmu.set("piston.mass", 8.0)
        second = fmu.run(LEVELS[900:1400], *model.states)
    wanted = heavy.simulate(LEVELS[400:900], heavy.state())
    assert largest_difference(wanted, first) < 1e-9
    assert largest_difference(lighter.simulate(LEVELS[900:1400], wanted[-1]), second) < 1e-9


def chosen_step(fmu: Any) -> None:
    fmu.set("integration_step", 0.0)


def too_heavy(fmu: Any) -> None:
    fmu.set("piston.mass", 1e9)


def no_number(fmu: Any) -> None:
    fmu.set("U", float("nan"))


def an_output(fmu: Any) -> None:
    fmu.set("effort", 1.0)


def no_volume(fmu: Any) -> None:
    fmu.start(chambers__volume_a=1e-8)


def state_later(fmu: Any) -> None:
    fmu.start()
    fmu.set("y", 0.1)


def backwards(fmu: Any) -> None:
    fmu.start()
    fmu.step(0.0, -1e-3)


def too_early(fmu: Any) -> None:
    fmu.step(0.0)


@both
@pytest.mark.parametrize(
    ("act", "said"),
    [
        (chosen_step, "integration_step is 0"),
        (too_heavy, "piston.mass is 1e+09; allowed is 0.001 to 10000"),
        (no_number, "not finite"),
        (an_output, "cannot be set"),
        (no_volume, "increase chambers.volume_a"),
        (state_later, "set it before the start"),
        (backwards, "it takes more than 0"),
        (too_early, "before the initialization ended"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_reason(act: Any, said: str, version: int, tmp_path: Path) -> None:
    with running(load_model("axis"), version, tmp_path) as fmu:
        with pytest.raises(fmpy.fmi1.FMICallException):
            act(fmu)
        assert said in fmu.told[-1]


@both
def test_a_run_goes_on_from_a_kept_state(version: int, tmp_path: Path) -> None:
    with running(load_model("axis"), version, tmp_path) as fmu:
        fmu.start()
        fmu.run(LEVELS[400:800], "y")
        get, set_ = ("getFMUState", "setFMUState") if version == 3 else ("getFMUstate", "setFMUstate")
        kept = getattr(fmu.fmu, get)()
        first = fmu.run(LEVELS[800:1300], "y", "v")
        getattr(fmu.fmu, set_)(kept)
        assert fmu.run(LEVELS[800:1300], "y", "v").tobytes() == first.tobytes()


@both
def test_model_exchange_agrees_with_short_steps_of_the_kernel(version: int, tmp_path: Path) -> None:
    """Through breakaway and a reversal, by the integrator of FMPy; a jump of the input is an event."""
    model = load_model("axis")
    jump = np.array([(0.0, 3.0), (1.0, 3.0), (1.0, -2.0), (2.0, -2.0)], dtype=[("time", float), ("U", float)])
    found = fmpy.simulate_fmu(
        str(written(model, version, tmp_path)), stop_time=2.0, output_interval=1e-2, input=jump, output=["y"],
        fmi_type="ModelExchange", relative_tolerance=1e-7,
    )  # fmt: skip
    wanted = model.simulate(np.repeat([3.0, -2.0], 1000), model.state(), step=1e-5)[:, 0]
    for time in (0.5, 1.0, 1.5, 2.0):
        row = np.searchsorted(found["time"], time - 1e-9)
        assert found["y"][row] == pytest.approx(wanted[round(time * 1000) - 1], abs=2e-6)


@both
def test_model_exchange_has_an_event_at_the_end_of_the_stroke_and_at_reversals(version: int, tmp_path: Path) -> None:
    model = load_model("axis")
    jump = np.array([(0.0, 6.0), (1.0, 6.0), (1.0, -6.0), (2.5, -6.0)], dtype=[("time", float), ("U", float)])
    found = fmpy.simulate_fmu(
        str(written(model, version, tmp_path)), stop_time=2.5, output_interval=1e-2, input=jump, output=["y", "v"],
        start_values={"y": 0.98}, fmi_type="ModelExchange", relative_tolerance=1e-6,
    )  # fmt: skip
    reach = 0.5 * model["piston.stroke"]
    between = found[np.abs(found["time"] * 100 - np.round(found["time"] * 100)) > 1e-6]  # only events lie there
    assert np.abs(between["y"] - reach).min() < 1e-6
    assert np.abs(between["v"]).min() < 1e-4
    assert found["y"].max() < reach + 0.01


@both
def test_model_exchange_applies_play_after_each_step(version: int, tmp_path: Path) -> None:
    base = load_model("axis")
    more = {"backlash.gap": 5e-3, "valve_hysteresis.half_width": 0.4}
    model = base.with_effects([*base.effects, "backlash", "valve_hysteresis"], more)
    time = np.arange(0.0, 3.0005, 1e-3)
    signal = np.array(list(zip(time, 4.0 * np.sin(4.0 * time), strict=True)), dtype=[("time", float), ("U", float)])
    found = fmpy.simulate_fmu(
        str(written(model, version, tmp_path)), stop_time=3.0, output_interval=1e-3, input=signal, step_size=1e-3,
        output=["y", "y_measured", "seen"], fmi_type="ModelExchange", relative_tolerance=1e-6, record_events=False,
    )  # fmt: skip
    held = signal["U"][:-1]
    states = model.simulate(held, model.state())
    wanted = model.outputs(states, held)
    assert np.ptp(wanted["y"] - wanted["y_measured"]) == pytest.approx(5e-3)  # the play is taken up on both sides
    for name, tolerance in {"y": 5e-4, "y_measured": 5e-4, "seen": 0.02}.items():
        assert np.abs(found[name][1:] - wanted[name]).max() < tolerance


@both
def test_sources_inside_compile_without_a_warning(version: int, tmp_path: Path) -> None:
    with zipfile.ZipFile(written(load_model("axis"), version, tmp_path)) as archive:
        archive.extractall(tmp_path)
    assert COMPILER is not None
    command = [COMPILER, *STRICT, "-c", "all.c", "-o", "all.o"]
    done = subprocess.run(command, cwd=tmp_path / "sources", capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@both
def test_equal_machines_give_equal_files(version: int, tmp_path: Path) -> None:
    one = written(load_model("axis"), version, tmp_path).read_bytes()
    assert fmu_archive(Exported(load_model("axis")), version) == one
