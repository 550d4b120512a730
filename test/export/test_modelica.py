"""The Modelica package of a machine: an independent Modelica compiler, Rumoca, moves it as the kernel does."""

from pathlib import Path

import numpy as np
import pytest
from plant.catalogue import CATALOGUE

from pneumo_ros.errors import UsageError
from pneumo_ros.export import Exported, modelica_text
from pneumo_ros.plant import Library, Model, load_model

AXIS = load_model("axis")
SAMPLE = 1e-3  # s
STEPS = ((0.1, 0.0), (0.5, 3.0), (np.inf, -3.0))  # end [s] and voltage [V]
BEFORE = {  # effects that read others
    "path_critical_ratios": ["choked_flow"], "subsonic_index": ["choked_flow"],
    "second_regulator": ["pressure_regulator"], "voltage_sag": ["dc_motor"],
}  # fmt: skip
EXPLICIT = ("position_dependent_friction", "pressure_regulator")  # Rumoca 0.10 refuses its own dense output of BDF here


def input_at(time: np.ndarray, scale: float) -> np.ndarray:
    """The voltage [V], or force [N] of 20 times it, at each time [s]."""
    ends = np.array([end for end, _ in STEPS])
    return scale * np.array([value for _, value in STEPS])[np.searchsorted(ends, time + 1e-9)]


def moved(model: Model, folder: Path, seconds: float, solver: str = "bdf") -> dict[str, float]:
    """Largest difference of each state between Rumoca and the kernel, over the largest value of that state."""
    rumoca = pytest.importorskip("rumoca", reason="a Modelica compiler; it comes with the extra 'dev'")
    machine = Exported(model)
    scale = 20.0 if model.force_driven else 1.0
    (end_0, u_0), (end_1, u_1), (_, u_2) = STEPS
    lines = [f"  m.U = {scale} * (if time < {end_0} then {u_0} elseif time < {end_1} then {u_1} else {u_2});"]
    lines += [f"  m.{one.name} = 0.0;" for one in machine.inputs if one.name != "U"]
    trial = "\n".join(["model Trial", f"  {machine.prefix}.Axis m;", "equation", *lines, "end Trial;", ""])
    file = folder / "trial.mo"
    file.write_text(modelica_text(machine) + trial)
    how = rumoca.SimConfig(solver=solver, rtol=1e-8, atol=1e-10, max_wall_seconds=200.0)
    found = rumoca.Session().load(str(file), model="Trial").simulate(t=(0.0, seconds), dt=10.0 * SAMPLE, config=how)
    count = round(seconds / SAMPLE)
    held = np.zeros((count, len(model.inputs)))
    held[:, 0] = input_at(SAMPLE * np.arange(count), scale)
    states = model.simulate(held, model.state(), sample_time=SAMPLE, step=1e-5)
    time = np.asarray(found.time)
    at = np.round(time / SAMPLE).astype(int) - 1
    both = (at >= 0) & (np.abs(time - (at + 1) * SAMPLE) < 1e-9)  # its events lie between samples
    assert both.sum() > 0.9 * seconds / (10.0 * SAMPLE)
    theirs = np.column_stack([np.asarray(found[f"m.{name}"])[both] for name in model.states])
    off, size = np.abs(theirs - states[at[both]]).max(axis=0), np.abs(states).max(axis=0)
    return dict(zip(model.states, (off / np.maximum(size, 1e-12)).tolist(), strict=True))


@pytest.mark.parametrize("name", ["axis", "emps"])
def test_a_shipped_machine_moves_as_in_the_kernel(name: str, tmp_path: Path) -> None:
    assert max(moved(load_model(name), tmp_path, 0.8).values()) < 1e-4


@pytest.mark.check
@pytest.mark.parametrize("effect", CATALOGUE, ids=lambda one: one.name)
def test_every_effect_of_continuous_time_moves_as_in_the_kernel(effect: type, tmp_path: Path) -> None:
    if ("advance" in effect.functions and not effect.invariant) or effect.name in AXIS.effects:
        pytest.skip("refused, or a part of the machine axis")
    model = AXIS.with_effects([*AXIS.effects, *BEFORE.get(effect.name, ()), effect.name])
    needs = EXPLICIT if effect.name not in BEFORE else (*EXPLICIT, "second_regulator")
    solver = "rk-like" if effect.name in needs else "bdf"
    assert max(moved(model, tmp_path, 0.8, solver).values()) < 1e-4


@pytest.mark.parametrize("name", ["backlash", "valve_hysteresis", "on_off_valves"])
def test_memory_from_step_to_step_is_refused(name: str) -> None:
    model = AXIS.with_effects([*AXIS.effects, name])
    with pytest.raises(UsageError, match=rf"effect {name} sets \w+ after each step.*export an fmu"):
        modelica_text(Exported(model))


OWN = '''
from pneumo_ros.plant.effect import Effect, Parameter


class Own(Effect):
    """A load in the words of Modelica."""

    flow = Parameter(1.0, "N", "a parameter with a word of Modelica as its name")

    def equations(y, v, flow):
        force, end = {line}, 1.0
        for when in range(2):
            force = force + end * when
        y, v = v, y
        force += 0.0 * y
        return force
'''


def own(folder: Path, line: str) -> str:
    """The package of the machine axis with an effect of this line."""
    file = folder / "own.py"
    file.write_text(OWN.format(line=line))
    model = Model.build([*AXIS.effects, "own"], AXIS.parameters, name="my own", library=Library([file]), defaults=True)
    return modelica_text(Exported(model))


def test_words_of_modelica_and_assigned_inputs_are_written_otherwise(tmp_path: Path) -> None:
    text = own(tmp_path, "flow % 3.0 if not v > 0.0 else min(flow, y, 2.0)")
    assert "package my_own\n" in text
    assert "input Real flow_;" in text
    assert "force := (if (not (v > 0.0)) then mod(flow_, 3.0) else min(min(flow_, y), 2.0));" in text
    assert "for when_ in 0:integer(2.0) - 1 loop" in text
    assert "y := y_given_;" in text
    assert "held_0_ := v;" in text


def test_an_effect_of_ones_own_moves_as_in_the_kernel(tmp_path: Path) -> None:
    pytest.importorskip("rumoca")
    own(tmp_path, "10.0 * flow * y")
    library = Library([tmp_path / "own.py"])
    model = Model.build([*AXIS.effects, "own"], AXIS.parameters, name="mine", library=library, defaults=True)
    assert max(moved(model, tmp_path, 0.4).values()) < 1e-4


def test_what_modelica_cannot_say_names_effect_and_line(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"effect own cannot be exported to Modelica: .*own\.py, line 11"):
        own(tmp_path, "math.gamma(flow)")
