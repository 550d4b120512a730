"""Segments cut from runs: each is simulated under the inputs and by the clock of its own part of its run."""

import numpy as np
from identify.making import own

from pneumo_ros.runs.run import PARTS
from pneumo_ros.shooting.segments import cut, cut_at

SAMPLES, PERIOD = 50, 1e-3
STARTS = [np.array([0, 30, 1000, 1949]), np.array([], dtype=np.int64), np.array([700])]  # some overlap; none of one run


def test_each_is_simulated_under_its_own_inputs_and_clock() -> None:
    """Against the run simulated from the same state; friction that warms up shows whether the clock is right."""
    model, _, slow = own("slow", seconds=2.0)
    runs = [slow, own("steps", seconds=2.0)[2], own("sweep", seconds=2.0)[2]]
    warm = model.with_effects(
        [*model.effects, "friction_warmup"], {"friction_warmup.share": 0.5, "friction_warmup.time_constant": 1.0}
    )
    for machine in (model, warm):
        segments = cut_at(machine, runs, STARTS, SAMPLES)
        assert len(segments.inputs) == (80 + 50 + 50 + 50) * PARTS
        for number, one in ((segments, 1), (segments.coarser(), 2)):
            found = number.simulate(machine, number.guess)
            for k, (run, at) in enumerate(zip(segments.run, segments.at, strict=True)):
                held = runs[run].input[at * PARTS : (at + SAMPLES) * PARTS].reshape(-1, one).mean(axis=1)
                alone = machine.simulate_lanes(
                    held, number.guess[k : k + 1], sample_time=PERIOD, parts=PARTS // one, step=number.step,
                    start=at * PERIOD,
                )  # fmt: skip
                np.testing.assert_allclose(found[k], alone[0], rtol=1e-12, atol=1e-15)


def test_some_segments_can_be_cut_alone() -> None:
    model, _, run = own("steps", seconds=4.0)
    runs, rows = [run, own("sweep", seconds=4.0)[2]], np.array([0, 3, 19, 20, 33])
    some, every = cut(model, runs, 0.2, rows), cut(model, runs, 0.2).pick(rows)
    np.testing.assert_array_equal(some.guess, every.guess)
    np.testing.assert_array_equal(some.residuals(model, some.guess), every.residuals(model, every.guess))
    assert len(some.inputs) == len(rows) * 0.2 / PERIOD * PARTS
