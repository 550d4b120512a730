"""Flow coefficients and dead zone from steady motion."""

from functools import lru_cache

import numpy as np
import pytest
from identify.constant import constant_run, truth

from pneumo_ros.identify.flow import CHOKED, COEFFICIENTS, LIMITS, FlowFit, fit_flow, flow_noise, measured_flow
from pneumo_ros.identify.steady import Window, find_windows
from pneumo_ros.plant import Model

FILL, EXHAUST = COEFFICIENTS
RIGHT, LEFT = LIMITS


@lru_cache(maxsize=32)
def windows(*volts: float, noisy: bool = True) -> list[Window]:
    return [w for one in volts for w in find_windows(truth(), constant_run(one, noisy=noisy))]


def started() -> Model:
    """The machine with valve parameters that are off by some per cent."""
    off = {FILL: 1.1, EXHAUST: 0.92, RIGHT: 1.02, LEFT: 0.98}
    return truth().with_parameters({name: truth()[name] * factor for name, factor in off.items()})


def check(fit: FlowFit, names: tuple[str, ...], within: float) -> None:
    for name in names:
        low, high = fit.intervals[name]
        assert fit.values[name] == pytest.approx(truth()[name], rel=within), name
        assert low - 0.5 * (high - low) < truth()[name] < high + 0.5 * (high - low), name
        assert high - low < 4.0 * within * truth()[name], name


def test_measured_flow_is_that_of_the_valve() -> None:
    """The mass balance of the chambers against the valve's equation, on noise-free windows."""
    for window in [w for w in windows(1.0, -1.0, noisy=False) if w.used]:
        opening = np.arctan(2.0 * (abs(window.input) - 0.78))
        fill, exhaust = truth()[FILL], truth()[EXHAUST]
        if window.input > 0.0:
            expected = (fill * (7e5 - window.pressure_a), -exhaust * (window.pressure_b - 1e5))
        else:
            expected = (-exhaust * (window.pressure_a - 1e5), fill * (7e5 - window.pressure_b))
        np.testing.assert_allclose(measured_flow(truth(), window), np.array(expected) * opening, rtol=2e-3)


def test_stated_noise_is_the_scatter() -> None:
    pairs = [
        (a, b) for a, b in zip(windows(1.0, -2.0), windows(1.0, -2.0, noisy=False), strict=True) if a.used and b.used
    ]
    off = [np.subtract(measured_flow(truth(), a), measured_flow(truth(), b)) / flow_noise(truth(), a) for a, b in pairs]
    assert np.std(off) == pytest.approx(1.0, abs=0.25)


def test_slow_and_fast_voltages_determine_all_four() -> None:
    fit = fit_flow(started(), windows(0.80, -0.80, 0.83, -0.83, 1.0, -1.0, 7.0, -7.0))
    assert not fit.undetermined
    check(fit, (FILL,), 1e-3)
    check(fit, (EXHAUST,), 5e-3)
    check(fit, (RIGHT, LEFT), 3e-4)


def test_a_spool_that_follows_the_command_changes_nothing() -> None:
    """In steady motion it stands at the command, and not where it rests."""
    with_spool = started().with_effects([*started().effects, "valve_spool_dynamics"])
    fit = fit_flow(with_spool, windows(0.80, -0.80, 0.83, -0.83, 1.0, -1.0, 7.0, -7.0))
    assert not fit.undetermined
    check(fit, (FILL,), 1e-3)
    check(fit, (RIGHT, LEFT), 3e-4)


def test_one_direction_leaves_the_other_limit() -> None:
    fit = fit_flow(started(), windows(0.80, 0.83, 1.0, 7.0))
    assert fit.undetermined == {LEFT: "needs runs at negative voltages"}
    assert LEFT not in fit.values
    check(fit, (FILL, RIGHT), 2e-3)


def test_fast_runs_alone_leave_the_dead_zone() -> None:
    """At 7 V the opening does not depend on the dead zone: coefficients are known, limits are not."""
    fit = fit_flow(started(), windows(7.0, -7.0))
    assert set(fit.undetermined) == {RIGHT, LEFT}
    assert fit.undetermined[LEFT].startswith("needs runs at several small negative voltages")
    check(fit, COEFFICIENTS, 1e-2)


def test_one_small_voltage_determines_nothing_by_itself() -> None:
    """Only products of coefficient and opening are seen; the opening depends on the limit."""
    fit = fit_flow(started(), windows(0.83))
    assert set(fit.undetermined) == {*COEFFICIENTS, *LIMITS}
    assert "more voltages" in fit.undetermined[FILL]


def test_too_few_windows() -> None:
    few = [w for w in windows(1.0) if w.used][:5]
    fit = fit_flow(started(), few)
    assert fit.values == {}
    assert fit.undetermined[FILL] == "5 steady stretches with an open valve are too few"


def test_a_machine_without_this_valve() -> None:
    plain = truth().with_effects([effect for effect in truth().effects if effect not in ("arctan_flow", "dead_zone")])
    fit = fit_flow(plain, windows(1.0))
    assert (fit.values, fit.undetermined) == ({}, {})


def test_the_law_of_iso_6358_has_its_own_coefficients() -> None:
    """Where it replaces the linear law, the coefficients of that one have no influence, and are not asked for."""
    effects = [*truth().effects, "choked_flow"]
    true = truth().with_effects(effects, dict(zip(CHOKED, (3e-9, 3.5e-9, 0.27), strict=True)))
    off = true.with_parameters(dict(zip(CHOKED, (2.7e-9, 3.8e-9, 0.22), strict=True)))
    runs = [constant_run(volts, model=true) for volts in (1.0, -1.0, 2.0, -2.0, 7.0, -7.0)]
    fit = fit_flow(off, [w for run in runs for w in find_windows(off, run)])
    assert not set(fit.undetermined) & {*CHOKED, *COEFFICIENTS}
    for name, within in zip(CHOKED, (0.02, 0.02, 0.1), strict=True):
        low, high = fit.intervals[name]
        assert fit.values[name] == pytest.approx(true[name], rel=within), name
        assert low - 0.5 * (high - low) < true[name] < high + 0.5 * (high - low), name
    mixed = off.with_parameters({"choked_flow.blend": 0.5})
    assert set(fit_flow(mixed, []).undetermined) == set(COEFFICIENTS)
