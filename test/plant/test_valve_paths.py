"""Each path of a valve by itself, the subsonic index and the delay of the command, against values that theory gives."""

import numpy as np
import pytest
from plant.catalogue import AXIS, in_python
from plant.test_effects_valve import flows

from pneumo_ros.identify.flow import fit_flow
from pneumo_ros.identify.steady import find_windows
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run

RHO = 1.185 * np.sqrt(293.15 / 293.0) * 2.0 / np.pi * np.arctan(2.0 * (10.0 - 0.78))  # kg/m3, at 10 V


def choked(*names: str, **values: float) -> Model:
    """The axis with ISO 6358 flow and further effects; keys section__parameter."""
    given = {key.replace("__", "."): value for key, value in values.items()}
    return AXIS.with_effects([*AXIS.effects, "choked_flow", *names], given)


@pytest.mark.parametrize("names", [(), ("choked_flow",)])
def test_each_path_has_its_own_conductance(names: tuple[str, ...]) -> None:
    plain = AXIS.with_effects([*AXIS.effects, *names])
    given = {"path_conductances.filling_difference": 0.2, "path_conductances.exhaust_difference": -0.4}
    model = plain.with_effects([*plain.effects, "path_conductances"], given)
    there, back = ([a / b for a, b in zip(flows(model, u, p_a=4e5, p_b=3e5), flows(plain, u, p_a=4e5, p_b=3e5),
                    strict=True)] for u in (10.0, -10.0))  # fmt: skip
    assert there == pytest.approx([0.9, 0.8], rel=1e-12), "P-A and B-T"
    assert back == pytest.approx([1.2, 1.1], rel=1e-12), "A-T and P-B"


def test_each_path_chokes_at_its_own_ratio() -> None:
    """Filling b 0.3 - 0.1 -+ 0.05, exhaust 0.3 + 0.1 -+ 0.02; the flow at a pressure ratio r is an ellipse."""
    model = choked(
        "path_critical_ratios", choked_flow__critical_ratio=0.3, path_critical_ratios__exhaust_excess=0.2,
        path_critical_ratios__filling_difference=0.1, path_critical_ratios__exhaust_difference=0.04,
    )  # fmt: skip
    fill, empty = model["choked_flow.conductance_filling"], model["choked_flow.conductance_exhaust"]

    def expected(C: float, p: float, r: float, b: float) -> float:
        return C * RHO * p * np.sqrt(1.0 - ((r - b) / (1.0 - b)) ** 2)

    p, r = 1.6e5, 1e5 / 1.6e5
    there, back = flows(model, 10.0, p_a=0.8 * 7e5, p_b=p), flows(model, -10.0, p_a=p, p_b=0.8 * 7e5)
    assert there == pytest.approx((expected(fill, 7e5, 0.8, 0.15), -expected(empty, p, r, 0.42)), rel=1e-9)
    assert back == pytest.approx((-expected(empty, p, r, 0.38), expected(fill, 7e5, 0.8, 0.25)), rel=1e-9)


def test_the_subsonic_index_shapes_the_flow_above_the_critical_ratio_only() -> None:
    bent, ellipse = choked("subsonic_index", subsonic_index__index=0.7), choked()
    assert flows(bent, 10.0, p_a=1.5e5)[0] == flows(ellipse, 10.0, p_a=1.5e5)[0]
    for ratio in (0.5, 0.8, 0.99):
        x = (ratio - 0.3) / 0.7
        share = flows(bent, 10.0, p_a=ratio * 7e5)[0] / flows(ellipse, 10.0, p_a=ratio * 7e5)[0]
        assert share == pytest.approx((1.0 - x * x) ** 0.2, rel=1e-9)
    near = [flows(bent, 10.0, p_a=ratio * 7e5)[0] for ratio in (0.9991, 1.0, 1.0009)]
    assert near[1] == 0.0
    assert near[0] > 0.0 > near[2]


@pytest.mark.parametrize("delay", [0.02, 4e-3])
def test_a_step_of_the_command_reaches_the_spool_one_delay_later(delay: float) -> None:
    """On average over time: the area between command and its delayed copy is the delay times the step."""
    model = AXIS.with_effects([*AXIS.effects, "command_delay"], {"command_delay.delay": delay})
    still = in_python(model.with_parameters({"piston.mass": 1e4, "lugre_friction.static_friction": 1e5}))
    up = np.full(round(6 * delay / 1e-4), 3.0)
    x = still.simulate(up, still.state(), sample_time=1e-4)
    opening = still.outputs(x, up)["opening"]
    u, late = np.where(opening > 0.0, opening + 0.78, 0.0), 3.0 - opening - 0.78
    assert u[-1] == pytest.approx(3.0, abs=1e-3)
    assert late[opening > 0.0].sum() * 1e-4 + (opening == 0.0).sum() * 3e-4 == pytest.approx(3.0 * delay, rel=0.05)


def test_identification_finds_the_differences_of_the_paths() -> None:
    """Steady motion both ways at seven voltages, from a machine whose paths differ."""
    truth = choked(
        "path_conductances", path_conductances__filling_difference=0.25, path_conductances__exhaust_difference=-0.15
    )
    known = truth.with_parameters(
        {"path_conductances.filling_difference": 0.0, "path_conductances.exhaust_difference": 0.0}
    )
    windows = []
    for volts in (-7.0, -4.0, -2.0, -1.6, 1.6, 2.0, 4.0, 7.0):
        held = np.full(3000, volts)
        x = truth.simulate(held, truth.state(y=-0.6 * np.sign(volts), p_a=4e5, p_b=4e5))
        y, p_a, p_b = x[:, 0], x[:, 2], x[:, 3]
        inside = np.abs(y) < 0.95
        count = len(y) if inside.all() else int(np.argmin(inside))
        run = Run(
            f"{volts:g} V", 1e-3, y[:count], p_a[:count], p_b[:count], np.full((count - 1) * PARTS, volts),
            np.ones(count, dtype=bool), False,
        )  # fmt: skip
        windows += find_windows(known, run)
    found = fit_flow(known, windows)
    assert found.values["path_conductances.filling_difference"] == pytest.approx(0.25, abs=0.02)
    assert found.values["path_conductances.exhaust_difference"] == pytest.approx(-0.15, abs=0.02)
