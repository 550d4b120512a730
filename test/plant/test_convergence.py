"""The order of the integrator: halving the step divides the error by four, in every phase of the bristle."""

import numpy as np
import pytest
from rig import oracle
from scipy.integrate import solve_ivp

from pneumo_ros.plant import Model, load_model

SAMPLE = 4e-3
BALANCE = {"p_a": 3e5, "p_b": (4.1e-4 * 3e5 - 11.0) / 3e-4}  # the forces of both chambers and the atmosphere cancel
SLIDING = {"y": -0.5, "v": 0.18, "p_a": 6.4e5, "p_b": 1.06e5, "z": 5e-5}
CASES = {  # voltages, start
    "sliding": (np.full(25, 3.0), SLIDING),
    "breakaway": (np.full(60, 3.0), {"y": -0.5, "p_a": 3e5, "p_b": 3.9e5}),
    "reversal": (np.repeat([3.0, -4.0], [10, 50]), {**SLIDING, "v": 0.1, "p_a": 5e5, "p_b": 2e5}),
    "stuck ringing": (np.zeros(30), {**BALANCE, "v": 0.002}),
    "fast": (np.full(15, 3.0), {**SLIDING, "v": 2.0, "z": 0.0}),
    "end stop": (np.full(40, 7.0), {**SLIDING, "y": 0.98}),
}
STEPS = (2e-4, 1e-4, 5e-5, 2.5e-5)


def reference(model: Model, voltage: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Samples from scipy's stiff solver on the model's own equations, restarted at every sample."""
    rows = [start]
    for held in voltage:
        solution = solve_ivp(
            lambda _, x, u=held: model.derivatives(x, u)[0],
            (0.0, SAMPLE),
            rows[-1],
            method="Radau",
            rtol=1e-10,
            atol=[1e-13, 1e-12, 1e-5, 1e-5, 1e-15],
            max_step=SAMPLE / 4,
        )
        rows.append(solution.y[:, -1])
    return np.array(rows[1:])


def errors(model: Model, voltage: np.ndarray, start: np.ndarray, exact: np.ndarray) -> np.ndarray:
    """Largest error of each state (rows) for each of STEPS (columns)."""
    runs = [model.simulate(voltage, start, sample_time=SAMPLE, step=h) for h in STEPS]
    return np.array([np.abs(run - exact).max(axis=0) for run in runs]).T


def order(error: np.ndarray) -> float:
    """Slope of the error over the step in logarithms, by least squares."""
    return float(np.polyfit(np.log(STEPS), np.log(error), 1)[0])


@pytest.mark.parametrize("case", CASES)
def test_halving_the_step_quarters_the_error(case: str) -> None:
    model, (voltage, given) = load_model("axis"), CASES[case]
    start = model.state(**given)
    by_state = errors(model, voltage, start, reference(model, voltage, start))
    # contact starts within a step, sometimes early, sometimes late: there only the mean has this order
    low, high = (1.4, 2.6) if case == "end stop" else (1.85, 2.35)
    for name, error in zip(model.states[:4], by_state, strict=False):
        assert low < order(error) < high, f"{name}: errors {error} for steps {STEPS}"
    assert by_state[0, 1] < 2e-5, "position at the default step"


# Onto the end stop, rest there, break away, slide back, reverse and stick, break away, glide with the valve shut, stick
MANOEUVRE = np.repeat([7.0, 0.0, -7.0, 3.0, 0.0, -1.2], [300, 100, 1000, 300, 200, 200])
START = {**SLIDING, "y": 0.97}


@pytest.fixture(scope="module")
def independent() -> np.ndarray:
    """The manoeuvre by the second simulator, which shares no code with ours; without damping the stops are alike."""
    return oracle.simulate({"end_stop_damping": 0.0}, MANOEUVRE, START, 1e-3)


def test_manoeuvre_holds_what_it_promises(independent: np.ndarray) -> None:
    y, v, z = independent[:, 0], independent[:, 1], independent[:, 4]
    assert y.max() > 1.0002, "pushes against the end stop"
    assert v.min() < -0.1, "breaks away and slides back"
    assert np.ptp(y[1480:1650]) < 2e-4, "sticks after the reversal"
    assert z.min() < -60e-6 < 60e-6 < z.max(), "bends the bristle both ways"


def test_independent_simulator_agrees(independent: np.ndarray) -> None:
    model = load_model("axis").with_parameters({"end_stop.damping": 0.0})
    runs = [model.simulate(MANOEUVRE, model.state(**START), step=h) for h in (1e-4, 5e-5, 2.5e-5)]
    coarse, middle, fine = (np.abs(run - independent).max(axis=0) for run in runs)
    assert np.all(fine < [1e-6, 1e-4, 1.0, 1.0, 1e-7])
    assert np.all(3.0 * fine[:4] < middle[:4])
    assert np.all(3.0 * middle[:4] < coarse[:4])


@pytest.mark.parametrize("speed", [-5.0, 0.5, 5.0])
def test_every_step_from_10_to_500_us_is_stable(speed: float) -> None:
    model = load_model("axis")
    start = model.state(v=speed, p_a=3e5, p_b=4e5)
    fine = model.simulate(np.full(300, 2.0), start, step=1e-6)
    for h in (1e-5, 1e-4, 2.5e-4, 5e-4):
        coarse = model.simulate(np.full(300, 2.0), start, step=h)
        assert np.abs(coarse[:, 0] - fine[:, 0]).max() < 2e-3
        assert abs(coarse[-1, 1] - fine[-1, 1]) < 5e-3


@pytest.mark.parametrize(
    ("stiffness", "damping", "step"), [(1e6, 5.0, 5e-4), (1e7, 0.0, 5e-4), (1e8, 0.0, 1e-4), (1e6, 1e3, 1e-4)]
)
def test_stiff_end_stops_hold(stiffness: float, damping: float, step: float) -> None:
    model = load_model("axis").with_parameters({"end_stop.stiffness": stiffness, "end_stop.damping": damping})
    x = model.simulate(np.full(1500, 7.0), model.state(**{**SLIDING, "y": 0.98}), step=step)
    assert x[:, 0].max() < 1.002
    assert np.abs(x[:, 1]).max() < 0.2
    assert 1.0 < x[-1, 0] < 1.0 + 350.0 / stiffness  # full pressure and friction on the spring
