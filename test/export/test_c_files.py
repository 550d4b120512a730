"""An exported machine compiles without a warning and does what the kernel does."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
from export.compiling import COMPILER, SAMPLE, STRIDE, compiled, largest_difference, needs_compiler
from plant import checks
from plant.catalogue import CATALOGUE, EFFECTS, actuated, everything, in_one_kernel, seeded

from pneumo_ros.export import Exported, c_files
from pneumo_ros.plant import Model, load_model
from pneumo_ros.plant.library import ACTUATORS

SHIPPED = ("axis", "paper", "emps")
LEVELS = np.repeat(np.random.default_rng(2).choice([-6.0, -3.0, -1.2, 0.0, 1.2, 3.0, 6.0], 25), 400)


def voltage(model: Model) -> np.ndarray:
    """10 s of steps that reach the end stops; as force [N] where there is no valve."""
    return LEVELS * (20.0 if model.force_driven else 1.0)


def kernel(model: Model, held: np.ndarray, start: np.ndarray) -> np.ndarray:
    """The same by the kernel."""
    return model.simulate(held, start, sample_time=SAMPLE, step=SAMPLE / STRIDE)


@needs_compiler
@pytest.mark.parametrize("name", SHIPPED)
def test_ten_seconds_equal_those_of_the_kernel(name: str, tmp_path: Path) -> None:
    model = load_model(name)
    held, start = voltage(model), model.state(y=0.1, v=0.2)
    assert largest_difference(kernel(model, held, start), compiled(model, tmp_path).run(held, start)) < 1e-9


@needs_compiler
@pytest.mark.parametrize("name", [name for name in ACTUATORS if name != "chambers"])
def test_every_actuator_equals_the_kernel(name: str, tmp_path: Path) -> None:
    model = actuated(name)
    held, start = voltage(model)[:2000], model.state(y=0.1, v=0.2)
    machine = compiled(model, tmp_path)
    assert largest_difference(kernel(model, held, start), machine.run(held, start)) < 1e-9
    state, out = machine.start(machine.defaults()), np.empty(len(machine.machine.outputs))
    machine.call("outputs", state, machine.held(2.0), machine.defaults(), out)
    signals = model.outputs(model.state()[None], np.array([2.0]), start=-1e-3)
    assert out == pytest.approx([float(signals[one.name][0]) for one in machine.machine.outputs], rel=1e-14, abs=1e-9)


@needs_compiler
def test_every_effect_of_the_catalogue_equals_the_kernel(tmp_path: Path) -> None:
    machine = compiled(everything(), tmp_path)
    for name in (effect.name for effect in CATALOGUE):
        model = in_one_kernel(name)
        model = model.with_parameters(checks.own_values(EFFECTS[name], seeded(name)))
        held, start = LEVELS[380:900], model.state(y=0.98, v=0.5)
        theirs = machine.run(held, start, model.values)
        assert largest_difference(kernel(model, held, start), theirs) < 1e-9, name


@needs_compiler
@pytest.mark.parametrize("name", SHIPPED)
def test_start_outputs_and_derivatives_are_those_of_the_model(name: str, tmp_path: Path) -> None:
    model = load_model(name)
    machine = compiled(model, tmp_path)
    q = machine.defaults()
    assert q.tolist() == model.values.tolist()
    state = machine.start(q)
    assert state.tolist() == [0.0, *model.state()]
    state[1:] = model.state(y=0.1, v=0.2)
    out, slopes, given = np.empty(len(machine.machine.outputs)), np.empty(len(state)), machine.held(2.0)
    machine.call("outputs", state, given, q, out)
    machine.call("derivatives", state, given, q, slopes)
    signals = model.outputs(state[None, 1:], np.array([2.0]), start=-1e-3)
    wanted = [float(signals[variable.name][0]) for variable in machine.machine.outputs]
    assert out == pytest.approx(wanted, rel=1e-14)
    assert slopes[1:] == pytest.approx(model.derivatives(state[None, 1:], 2.0)[0], rel=1e-14)
    assert slopes[0] == 1.0


@needs_compiler
def test_one_step_is_an_advance_by_one_and_moves_time_on(tmp_path: Path) -> None:
    machine = compiled(load_model("axis"), tmp_path)
    q = machine.defaults()
    one, ten = machine.start(q), machine.start(q)
    for _ in range(10):
        machine.call("step", one, machine.held(3.0), q, 1e-4)
    machine.call("advance", ten, machine.held(3.0), q, 1e-4, 10)
    assert one == pytest.approx(ten, rel=1e-12)
    assert ten[0] == pytest.approx(1e-3, rel=1e-12)


def test_header_carries_units_meanings_and_names_of_the_machine_file() -> None:
    model = load_model("axis")
    header, source = c_files(Exported(model), "axis.h")
    for dotted, value in model.parameters.items():
        section, _, key = dotted.partition(".")
        specification = model.specification(dotted)
        assert f"double {key}; /* {specification.unit}, {specification.meaning} */" in header
        assert f"p->{section}.{key} = {value!r};" in source


@needs_compiler
def test_header_compiles_as_cpp(tmp_path: Path) -> None:
    header, _ = c_files(Exported(load_model("axis")), "axis.h")
    (tmp_path / "axis.h").write_text(header)
    (tmp_path / "use.cpp").write_text('#include "axis.h"\nint main() { axis_state x; axis_parameters p; '
                                      "axis_parameters_default(&p); axis_init(&x, &p); return 0; }\n")  # fmt: skip
    assert COMPILER is not None
    flags = ["-x", "c++", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"]
    done = subprocess.run([COMPILER, *flags, str(tmp_path / "use.cpp")], capture_output=True, text=True)
    if "cc1plus" in done.stderr:
        pytest.skip("this compiler has no C++; type: sudo apt install g++")
    assert done.returncode == 0, done.stderr
