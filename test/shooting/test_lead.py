"""Starts of segments of machines with on/off valves and regulators: what the command tells is not estimated."""

from functools import lru_cache

import numpy as np
import pytest
from identify.jogging import sheet, true_and_seen, truth
from plant.catalogue import AXIS

from pneumo_ros.plant import Model
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.shooting.segments import cut_at
from pneumo_ros.shooting.start import start_states

PLAIN = [name for name in AXIS.effects if name != "dead_zone"]
VALVES = {
    "pulses": ("on_off_valves",),
    "regulators": ("pressure_regulator", "second_regulator"),
    "spool": ("valve_spool_dynamics",),
}
AT = np.array([0, 700, 1213, 1999])


@lru_cache
def recorded(kind: str) -> tuple[Model, np.ndarray, Run]:
    """A machine, its true states (n, states) and its run of 2.5 s with noise; the command changes every 0.1 s."""
    model, rng, n = AXIS.with_effects([*PLAIN, *VALVES[kind]]), np.random.default_rng(0), 2500
    volts = np.repeat(rng.uniform(1.0, 5.0, (n // 100, len(model.inputs))), 100, axis=0)
    held = np.repeat(volts[:-1], PARTS, axis=0)
    begin = model.state(p_a=3e5, p_b=3.9e5)
    truth = np.vstack([begin, model.simulate(held, begin, sample_time=1e-3, parts=PARTS)])
    y, a, b = (truth[:, i] + s * rng.normal(size=n) for i, s in ((0, 5e-6), (2, 300.0), (3, 300.0)))
    further = {"U_b": held[:, 1]} if len(model.inputs) > 1 else {}
    return model, truth, Run(kind, 1e-3, y, a, b, held[:, 0].copy(), np.ones(n, dtype=bool), False, further)


@pytest.mark.parametrize("kind", VALVES)
def test_states_of_the_valve_are_exact(kind: str) -> None:
    model, truth, run = recorded(kind)
    found = start_states(model, run, AT[1:])
    columns = [model.states.index(name) for name in model.composition.commanded]
    np.testing.assert_array_equal(found[:, columns], truth[AT[1:]][:, columns])


def test_the_valve_follows_the_parameters_of_each_copy() -> None:
    """A slower valve stands elsewhere at the start: the slope by its delay is that of the whole recording."""
    model, _, run = recorded("pulses")
    segments = cut_at(model, [run], [AT[1:]], 100)
    late = model.with_parameters({"on_off_valves.switch_on": 8e-3, "on_off_valves.switch_off": 1e-3})
    both = np.repeat(np.stack([model.values, late.values]), len(segments), axis=0)
    found = segments.completed(model, np.tile(segments.guess, (2, 1)), both)
    np.testing.assert_array_equal(found, np.concatenate([segments.guess, segments.guessed(late).guess]))
    assert not np.array_equal(*np.split(found, 2))


def test_where_a_recording_begins_the_spool_is_estimated() -> None:
    """Nothing is known of the command before; levels and clocks of on/off valves are at rest there."""
    model, _, run = recorded("spool")
    estimated = cut_at(model, [run], [AT], 100).estimated(model)
    assert estimated[0].all()
    assert not estimated[1:, model.states.index("x_s")].any()


def test_starts_among_pulses_are_near_the_true_states() -> None:
    """Fits of 0.3 s end in neighbouring minima, as each pulse may break the piston away: 17 um off (median)."""
    model = truth(sheet("pulses"))
    real, run = true_and_seen(model, "jog", 6.0, 0.4)
    at = np.arange(1000, 5500, 250)
    off = np.median(np.abs(start_states(model, run, at)[:, :4] - real[at]), axis=0)
    assert np.all(off < [3e-6, 3e-4, 60.0, 60.0])
