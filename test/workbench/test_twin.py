"""The live twin: predictions beside measured curves, near for the true machine and far for a wrong one."""

from types import SimpleNamespace

import numpy as np
import pytest
from flask import Flask

from pneumo_ros.plant import Model, load_model
from pneumo_ros.workbench.data import answer_page
from pneumo_ros.workbench.twin import WINDOW, Curves, Twin, predicted

SECONDS = 3.2


@pytest.fixture(scope="module")
def curves() -> Curves:
    """What the watcher would send of the default machine that a voltage steps to and fro, 100 values a second."""
    model = load_model()
    time = np.arange(round(SECONDS * 1000)) * 1e-3
    volts = np.where(time < 0.8, 1.6, np.where(time < 1.9, -1.8, 2.2))
    states = model.simulate(np.repeat(volts, 10), model.state(p_a=3e5, p_b=3.9e5), sample_time=1e-3, parts=10)
    named = {"position": states[:, 0], "pressure_a": states[:, 2], "pressure_b": states[:, 3], "voltage": volts}
    times = {name: time + (0.0 if name == "voltage" else 1e-3) for name in named}
    return {name: (times[name][::10].tolist(), values[::10].tolist()) for name, values in named.items()}


def test_the_true_machine_predicts_what_happens_and_a_wrong_one_does_not(curves: Curves) -> None:
    true = predicted(load_model(), curves, 0.6)
    assert (true.time[0], true.time[-1]) == pytest.approx((0.61, 1.6), abs=0.011)
    moved = np.ptp(true.values["position"])
    assert np.abs(true.errors["position"]).max() < 0.02 * moved
    wrong = predicted(load_model().with_parameters({"lugre_friction.coulomb_friction": 20.0}), curves, 0.6)
    assert np.abs(wrong.errors["position"]).max() > 5.0 * np.abs(true.errors["position"]).max()


def test_windows_follow_each_other_and_stay_beside_the_measurements(curves: Curves) -> None:
    twin, model = Twin(20), load_model()
    for end in np.arange(0.2, SECONDS, 0.25):
        heard = {n: ([t for t in ts if t < end], vs[: sum(t < end for t in ts)]) for n, (ts, vs) in curves.items()}
        thread = twin.look({n: c for n, c in heard.items() if c[0]}, lambda: model)
        if thread:
            thread.join(60.0)
    assert len(twin.windows) == 2
    first, second = twin.windows
    assert second.time[0] - first.time[0] == pytest.approx(WINDOW, abs=0.011)
    times, values = twin.curve("position") or ([], [])
    assert len(times) == len(values) == len(first.time) + len(second.time) + 2  # a gap ends each
    assert "Over the last second the model was off by: position " in twin.says()


@pytest.mark.parametrize(("coordinate", "unit", "speed"), [("translation", "mm", "m/s"), ("rotation", "mrad", "rad/s")])
def test_the_page_gets_the_units_of_the_machine(coordinate: str, unit: str, speed: str) -> None:
    times = np.linspace(0.0, 1.0, 50).tolist()
    live = SimpleNamespace(curves=lambda: {"position": (times, times)}, twin=Twin(20), status={}, answer="")
    desk = SimpleNamespace(coordinate=coordinate, live=live, model=load_model)
    server = Flask("page")
    answer_page(server, SimpleNamespace(of=lambda place: desk), {})
    found = server.test_client().post("/live/one", json={}).get_json()
    assert [panel["title"] for panel in found["chart"]["panels"]] == [f"position [{unit}]"]
    assert f" {speed}." in found["says"]


def test_what_is_lacking_is_said(curves: Curves) -> None:
    twin = Twin(20)

    def unused() -> Model:
        raise AssertionError

    assert twin.look({"position": curves["position"]}, unused) is None
    assert twin.says() == "No prediction yet: it needs pressure_a and pressure_b and voltage."
