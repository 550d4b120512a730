"""Positions that lag the force by less than a sample, on a simulated axis that a measured force drives."""

from dataclasses import fields
from functools import lru_cache

import numpy as np
import pytest

from pneumo_ros.command.adding_json import adding_dict
from pneumo_ros.command.adding_text import text
from pneumo_ros.diagnose.adding import add
from pneumo_ros.diagnose.timing import lateness, later
from pneumo_ros.plant import load_model
from pneumo_ros.runs.run import PARTS, Run

AXIS = load_model("emps")
DT, SECONDS = 1e-3, 12.0


@lru_cache(maxsize=4)
def run(late: float) -> Run:
    """Back and forth by jerks of the force; positions are those of `late` [s] ago, with noise of a fine encoder."""
    rng, n = np.random.default_rng(0), round(SECONDS / DT) + 1
    levels = np.repeat(rng.uniform(40.0, 90.0, 60) * np.resize([1.0, -1.0], 60), n // 60 + 1)
    force = np.convolve(levels, np.ones(20) / 20, "same")[:n]
    cells = (np.arange((n - 1) * PARTS) + 0.5) / PARTS
    held = np.interp(cells, np.arange(n), force)
    fine = AXIS.simulate(held, AXIS.state(), sample_time=DT / PARTS)[:, 0]
    at = np.arange(n) * PARTS - late / (DT / PARTS)
    position = np.interp(at, np.arange(len(fine) + 1), np.append(0.0, fine)) + 2e-7 * rng.standard_normal(n)
    return Run("axis", DT, position, None, None, held, np.ones(n, dtype=bool), True)


@pytest.mark.parametrize("late", [0.4e-3, 0.8e-3])
def test_it_is_found_to_a_tenth_of_a_sample(late: float) -> None:
    assert lateness(AXIS, [run(late)]) == pytest.approx(late, abs=1e-4)


def test_no_lateness_is_seen_where_there_is_none() -> None:
    assert lateness(AXIS, [run(0.0)]) == 0.0


def test_what_is_as_late_as_a_sample_is_an_effect() -> None:
    assert lateness(AXIS, [run(2.5e-3)]) == 0.0


def test_the_input_is_put_off_and_nothing_else_changes() -> None:
    given = run(0.0)
    put_off = later(given, 0.32e-3)
    np.testing.assert_array_equal(put_off.input[3:], given.input[:-3])
    np.testing.assert_array_equal(put_off.input[:3], given.input[0])
    assert all(
        getattr(put_off, f.name) is getattr(given, f.name) for f in fields(Run) if f.name not in ("input", "further")
    )
    assert later(given, 0.0) is given


@pytest.mark.check
def test_an_effect_added_by_name_is_timed_too_and_says_so() -> None:
    """Half a millisecond of lag causes errors of newtons where the axis jerks; the friction law would absorb them."""
    found = add(AXIS, ["asymmetric_viscous_friction"], [run(0.8e-3)])
    result = adding_dict(found)
    assert result["input_delay_s"] == found.late == pytest.approx(0.8e-3, abs=1e-4)
    assert "Positions come 0.8" in text(result)
    assert found.after.equations["momentum"].explained_by_noise


@pytest.mark.check
def test_a_delay_that_is_to_be_added_is_left_to_the_effect() -> None:
    found = add(AXIS, ["position_sensor_delay"], [run(0.8e-3)])
    assert found.late == 0.0
    late = [found.estimates[f"position_sensor_delay.{name}"].value for name in ("delay", "low_pass")]
    assert sum(late) == pytest.approx(0.8e-3, abs=1e-4)  # below a sample, a delay is like a low-pass
