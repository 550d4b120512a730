"""Sensor effects: corrected before states are guessed, predicted and refitted as any other effect."""

import inspect
import re
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from identify.making import own, ratio, rig
from rig.effects import Wish, build

from pneumo_ros.plant import Model
from pneumo_ros.plant.library import Library
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.runs.sensors import LONGEST, QUICK, corrected, corrected_lanes, driven, inverted, longest_step
from pneumo_ros.runs.smooth import smooth
from pneumo_ros.shooting.refit import Refit, refit
from pneumo_ros.shooting.segments import cut
from pneumo_ros.shooting.windows import predict

OFFSET, GAIN, DELAY = "pressure_sensor_offset", "pressure_sensor_gain", "position_sensor_delay"
SIZES = {
    OFFSET: {"offset_a": 0.0, "offset_b": 12e3},
    GAIN: {"error_a": 0.0, "error_b": 0.015},
    DELAY: {"delay": 8e-3},
    "backlash": {"gap": 5e-4},
}
ON_RIG = {OFFSET: 12e3, GAIN: 0.015, DELAY: 8e-3, "backlash": 2.5e-4}  # the rig's play is a half width


def alone(model: Model, effect: str, **values: float) -> Model:
    """The model with a sensor effect of the given values."""
    given = {f"{effect}.{key}": value for key, value in values.items()}
    return model.with_effects([*model.effects, effect], given)


def with_effect(model: Model, effect: str, **values: float) -> Model:
    """The model with a sensor effect of the given values, by one kernel for all of them: the others are neutral."""
    for other, sizes in SIZES.items():
        model = alone(model, other, **dict.fromkeys(sizes, 0.0))
    return model.with_parameters({f"{effect}.{key}": value for key, value in values.items()})


@lru_cache(maxsize=8)
def on_rig(effect: str) -> tuple[Model, Model, Run]:
    """Model of the rig without and with the effect that it hides, and one of its runs."""
    base, _, run = rig("train_sweep", 3, effect, ON_RIG[effect])
    hidden = build(3, [Wish(effect, ON_RIG[effect])]).machine
    truth = {
        OFFSET: {"offset_a": hidden.offset_a, "offset_b": hidden.offset_b},
        GAIN: {"error_a": hidden.gain_a, "error_b": hidden.gain_b},
        DELAY: {"delay": hidden.position_delay},
        "backlash": {"gap": 2.0 * hidden.encoder_play},
    }
    return base, with_effect(base, effect, **truth[effect]), run


@pytest.fixture(scope="module")
def untold(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """The catalogue and `untold_delay`, which is the sensor's delay without what its roles tell of it."""
    effect = Library().find(DELAY)
    file = tmp_path_factory.mktemp("effects") / "untold_delay.py"
    text = Path(inspect.getfile(effect)).read_text(encoding="utf-8").replace("PositionSensorDelay", "UntoldDelay")
    file.write_text(re.sub(', role="[a-z-]+"', "", text), encoding="utf-8")
    return Library([file])


def beside(model: Model, library: Library, delay: float) -> Model:
    """The model with the delay of `untold`."""
    given = {**model.parameters, "untold_delay.delay": delay, "untold_delay.low_pass": 0.0}
    return Model.build([*model.effects, "untold_delay"], given, name="untold", library=library)


def seen(effect: str, **values: float) -> tuple[Model, np.ndarray, Run]:
    """A model with a sensor effect, its true states and what its sensors read, without noise."""
    base, _, run = own("sweep", noisy=False, seconds=10.0)
    model = with_effect(base, effect, **(values or SIZES[effect]))
    start = model.state(p_a=3e5, p_b=3.9e5)
    states = np.vstack([start, model.simulate(run.input, start, parts=PARTS)])
    read = model.outputs(states)
    return (
        model,
        states,
        replace(run, position=read["y_measured"], pressure_a=read["p_a_measured"], pressure_b=read["p_b_measured"]),
    )


# permitted remainder as a share of the sensor error, rms
@pytest.mark.parametrize(("effect", "share"), [(OFFSET, 0.01), (GAIN, 0.01), (DELAY, 0.05), ("backlash", 0.5)])
def test_what_the_sensors_did_is_taken_back(effect: str, share: float) -> None:
    model, states, run = seen(effect)
    frame = run.smoothed.frame
    column = 0 if effect in (DELAY, "backlash") else 3
    before, after = (one[:, column] - states[:, column] for one in (frame, corrected(model, frame, run)))
    assert ratio(after, 1.0) < share * ratio(before, 1.0)


def test_the_velocity_behind_a_delay_is_that_of_later() -> None:
    model, states, run = seen(DELAY)
    frame = run.smoothed.frame
    before, after = (np.abs(one[:, 1] - states[:, 1]) for one in (frame, corrected(model, frame, run)))
    assert np.median(after) < 0.3 * np.median(before)


@pytest.mark.parametrize("time_constant", [5e-3, 14e-3, 30e-3])
def test_what_a_low_pass_smoothed_is_made_good(time_constant: float) -> None:
    """Two steps of the fixed point left a third of what passes it at its corner: breakaways came late and blurred."""
    model, states, run = seen(DELAY, delay=0.0, low_pass=time_constant)
    best = replace(run, position=states[:, 0]).smoothed.frame
    left, least = (ratio(one[:, 1] - states[:, 1], 1.0) for one in (corrected(model, run.smoothed.frame, run), best))
    assert left < 1.1 * least


def test_a_long_delay_is_taken_back_without_its_noise() -> None:
    """Of 20 ms: steps of the fixed point alone left a velocity eight times as noisy, and a payload was found."""
    base, truth, run = own("sweep", seconds=10.0)
    late = 0.02
    moved = np.interp(run.sample_time * np.arange(len(run)) - late, run.sample_time * np.arange(len(run)), run.position)
    delayed = replace(run, position=moved)
    model = with_effect(base, DELAY, delay=late)
    plain, found = run.smoothed.frame, corrected(model, delayed.smoothed.frame, delayed)
    inner = slice(100, -100)
    usual, left = (ratio((one[:, 1] - truth[:, 1])[inner], 1.0) for one in (plain, found))
    assert left < 2.0 * usual


@pytest.mark.parametrize("delay", [1e-3, 1.5e-3, 8.25e-3])
def test_a_late_reading_keeps_its_noise_in_windows_of_motion(delay: float) -> None:
    """Straight lines between two samples took noise out, and a delay of 1.2 ms lost 27 nats against one of 1.0 ms."""
    base, _, run = own("steps", seconds=3.0)
    model, frame = alone(base, DELAY, delay=delay, low_pass=0.0), run.smoothed.frame
    noisy = frame.copy()
    noisy[:, 0] += np.random.default_rng(0).normal(0.0, 1e-5, len(frame))
    inside = slice(50, -50)
    added = (inverted(model, noisy, None, run) - inverted(model, frame, None, run))[0, :, 0] + (noisy - frame)[:, 0]
    slow = [smooth(one, 1e-3, 4e-3, 3)[inside] for one in (added, (noisy - frame)[:, 0])]
    assert np.std(slow[0]) == pytest.approx(np.std(slow[1]), rel=0.02)


def test_a_simulation_starts_where_the_model_reads_what_was_measured() -> None:
    """In the middle of a play the position was 52 um off what the sensor read, and 1 s later a window 0.46 mm."""
    _, true, run = on_rig("backlash")
    states = driven(true, run.smoothed.frame, run)[0]
    read = true.outputs(states, run.sampled(true.inputs))["y_measured"]
    assert np.max(np.abs(read - run.smoothed.motion[:, 0])) < 1e-9


def test_true_sensors_give_the_frame_back_and_drive_as_follow_does() -> None:
    model, _, run = own("steps", seconds=3.0)
    frame = run.smoothed.frame
    assert corrected(model, frame, run) is frame
    held = run.averaged(model.inputs, QUICK)
    expected = model.follow(frame, held, model.state()[4:], step=run.sample_time / QUICK, parts=QUICK)
    np.testing.assert_array_equal(driven(model, frame, run), expected)


@pytest.mark.parametrize("delay", [0.0, 1e-4, 2e-3])
def test_the_fastest_sensor_is_stable_in_its_longest_step(delay: float) -> None:
    """In steps of 1 ms, as in a ranking or at 500 Hz, a position that is late by 2 ms or less runs away."""
    base, _, run = own("steps", seconds=3.0)
    model = with_effect(base, DELAY, delay=delay)
    frame, held = run.smoothed.frame, run.averaged(model.inputs, 1)

    def lag(step: float) -> float:
        states, _ = model.follow(frame, held, model.state()[4:], step=step, parts=1)
        return float(np.abs(states[:, model.states.index("further")]).max())

    assert lag(longest_step(model, run, 1)) < 0.01
    assert not lag(LONGEST) < 0.01
    assert longest_step(model, run, 1, true_sensors=True) == longest_step(base, run, 1) == LONGEST


def test_a_lane_whose_sensors_run_away_has_no_states(untold: Library) -> None:
    """Taken as measured, it passed for a machine without the offset: the offset seemed to change nothing."""
    base, _, run = own("steps", seconds=3.0)
    model, frame = beside(alone(base, OFFSET, offset_a=0.0, offset_b=12e3), untold, 1e-9), run.smoothed.frame
    held, rest = run.averaged(model.inputs, 1), model.state()[4:]
    lanes, names = np.tile(model.values, (2, 1)), model.states[4:]

    def corrected_in(step: float) -> np.ndarray:
        def drive(given: np.ndarray, moving: np.ndarray) -> np.ndarray:
            some = {"sample_time": 1e-3, "step": step, "parts": 1, "states": names}
            return model.follow_lanes(given, held, rest, lanes[moving], **some)[0]

        return corrected_lanes(model, frame, run, lanes, drive, names, (1e-9, 1e-2, 1e-2))

    assert np.isnan(corrected_in(LONGEST)).all()
    given = corrected_in(longest_step(model, run, 1))
    np.testing.assert_allclose(given[:, :, 3], np.tile(frame[:, 3] - 12e3, (2, 1)), atol=1.0)


def test_two_parts_of_a_sample_drive_the_states_of_effects_as_well_as_ten() -> None:
    """Within 1 % of the scatter of each state, also of a lag of 5 ms; a bristle that rests is unknown in any case."""
    model, _, run = own("steps", seconds=3.0)
    lagging = model.with_effects([*model.effects, "friction_lag"], {"friction_lag.time_constant": 5e-3})
    frame = run.smoothed.frame
    fine, _ = lagging.follow(frame, run.input, lagging.state()[4:], parts=PARTS)
    states, _ = driven(lagging, frame, run)
    moving = np.abs(frame[:, 1]) > 0.01
    assert moving.sum() > 300
    apart = np.sqrt(np.mean((states - fine)[moving] ** 2, axis=0))
    assert np.all(apart <= 0.01 * np.std(fine, axis=0))


def test_neutral_sensors_correct_nothing() -> None:
    base, _, run = own("steps", seconds=3.0)
    model = with_effect(base, OFFSET)
    frame = run.smoothed.frame
    np.testing.assert_array_equal(corrected(model, frame, run), frame)


def position_and_pressures(model: Model, run: Run) -> tuple[float, float]:
    """Window errors in noise floors: of position, and the larger one of the pressures."""
    noise = run.noise
    found = {name: ratio(errors, noise[name]) for name, errors in predict(model, run, 1.0).errors.items()}
    return found["position_m"], max(found["pressure_a_pa"], found["pressure_b_pa"])


@pytest.mark.parametrize("effect", SIZES)
def test_the_true_sensors_predict_the_independent_rig(effect: str) -> None:
    base, true, run = on_rig(effect)
    position, pressure = position_and_pressures(true, run)
    assert position < 1.3
    assert pressure < 1.05
    assert position_and_pressures(base, run)[0] > 10.0


def found_on_rig(effect: str) -> tuple[Model, Refit]:
    """True model, and the refit of the sensor effect from zero."""
    base, true, run = on_rig(effect)
    free = [f"{effect}.{key}" for key in SIZES[effect]]
    start = with_effect(base, effect, **dict.fromkeys(SIZES[effect], 0.0))
    priors = {OFFSET: 2e4, GAIN: 0.03, DELAY: 0.02, "backlash": 1e-3}
    return true, refit(start, [run], free=free, priors=dict.fromkeys(free, priors[effect]))


@pytest.mark.parametrize("effect", [OFFSET, GAIN, DELAY, pytest.param("backlash", marks=pytest.mark.check)])
def test_sensor_effects_are_refitted_from_nothing(effect: str) -> None:
    true, found = found_on_rig(effect)
    for name, estimate in found.estimates.items():
        size = max(true[other] for other in found.estimates)
        assert estimate.determined
        assert estimate.value == pytest.approx(true[name], abs=0.05 * abs(size)), name


def test_the_prior_on_starts_is_on_what_sensors_read() -> None:
    """A guess that assumes ideal sensors does not pull an offset, refitted later, towards zero."""
    base, _, run = own("steps", seconds=3.0)
    neutral = alone(base, OFFSET, offset_a=0.0, offset_b=0.0)
    segments = cut(neutral, [run], 0.5)
    shifted = alone(base, OFFSET, offset_a=5e3, offset_b=-2e3)
    np.testing.assert_allclose(segments.seated(shifted) - segments.guess, [[0.0, 0.0, -5e3, 2e3, 0.0]] * 5, atol=1e-6)
    np.testing.assert_allclose(segments.from_guess(shifted, segments.seated(shifted)), 0.0, atol=1e-9)
    away = segments.from_guess(shifted, segments.guess)[0]
    np.testing.assert_allclose(away[:, 2], 5e3 / segments.scale[:, 2])


def test_time_restarts_in_every_recording() -> None:
    """Friction that warms up does so in the second recording as it did in the first."""
    base, _, run = own("steps", seconds=3.0)
    model = base.with_effects(
        [*base.effects, "friction_warmup"], {"friction_warmup.share": 0.5, "friction_warmup.time_constant": 2.0}
    )
    segments = cut(model, [run, run], 0.5)
    first, second = segments.simulate(model, segments.guess).reshape(2, 5, *segments.measured.shape[1:2], 5)
    np.testing.assert_allclose(first, second, rtol=1e-9, atol=1e-12)


def test_a_lane_that_leaves_the_finite_numbers_ends_no_diagnosis(untold: Library) -> None:
    """Smoothing its correction raised a ValueError, and one wild parameter ended a whole diagnosis."""
    model, truth, run = own("steps", seconds=1.0)
    late = beside(model, untold, 8e-3)
    names = late.states[4:]
    wild = np.zeros((1, len(run), len(names)))
    wild[0, -1, names.index("behind")] = np.inf
    parameters, enough = late.values[None], (1e-9, 1e-2, 1e-2)
    given = corrected_lanes(late, truth[:, :4], run, parameters, lambda frame, lanes: wild, names, enough)
    assert np.isnan(given).all()
