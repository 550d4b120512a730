"""Variants driven along a recording with sensor effects: many at once give the result of each alone."""

from pathlib import Path

import numpy as np
import pytest
from identify.making import own

from pneumo_ros.diagnose.follow import alike_sensors, follow_each, frame_of, unsensed
from pneumo_ros.plant import Model, load_model
from pneumo_ros.runs.readings import must_drive, sensing

SENSORS = ("position_sensor_delay", "pressure_sensor_offset")
MODEL, _, RUN = own("steps", seconds=3.0)
EVERY = np.arange(len(RUN))
SERVO = """/**:
  ros__parameters:
    effects: [position_loop, dc_motor]
    piston: {mass: 0.007, area_a: 1.0e-4, area_b: 1.0e-4, stroke: 7.0}
    position_loop: {proportional_gain: 1.0}
    dc_motor: {force_per_volt: 0.1, back_emf: 0.4, source_voltage: 7.4}
"""
LATE = MODEL.with_effects([*MODEL.effects, *SENSORS])


def variants(model: Model) -> np.ndarray:
    """Parameter vectors: three friction levels, two of them with another delay, one with another offset."""
    names, rows = list(model.parameters), np.tile(model.values, (6, 1))
    rows[:3, names.index("lugre_friction.coulomb_friction")] *= [1.0, 1.01, 0.99]
    rows[3:5, names.index("position_sensor_delay.delay")] *= 1.2
    rows[5, names.index("pressure_sensor_offset.offset_a")] *= -1.0
    return rows


def driven(rows: np.ndarray) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    return {v.index: (v.states(EVERY), v.claimed) for v in follow_each(LATE, frame_of(RUN, LATE.chambers), rows)}


@pytest.mark.parametrize("kind", ["steps", "sine", "sweep"])
def test_velocities_add_up_to_the_way(kind: str) -> None:
    """Effects integrate them: at noise of 6 um, rests that began and ended within its range lost up to 0.5 mm."""
    model, _, run = own(kind)
    frame = frame_of(run, model.chambers)
    velocity, y = frame.states[:, 1], run.smoothed.motion[:, 0]
    gone = np.cumsum(0.5 * (velocity[1:] + velocity[:-1])) * run.sample_time
    assert 0.2 < np.mean(velocity == 0.0) < 0.5
    assert np.max(np.abs(gone - (y[1:] - y[0]))) < 1e-4


def test_variants_with_the_same_sensors_are_one_group() -> None:
    _, group = alike_sensors(LATE, variants(LATE))
    assert group[0] == group[1] == group[2]
    assert group[3] == group[4]
    assert len(set(group)) == 3


def test_a_play_before_the_load_leaves_the_sensors_alike() -> None:
    """What lies behind it, and the mass that it reads, change no reading; the play before the sensor does."""
    model = LATE.with_effects([*LATE.effects, "backlash"], {"backlash.gap": 0.0, "backlash.load_share": 0.2})
    names, rows = list(model.parameters), np.tile(model.values, (4, 1))
    rows[1, names.index("piston.mass")] *= 1.1
    rows[2, names.index("backlash.load_share")] *= 1.1
    rows[3, names.index("backlash.gap")] = 1e-4
    _, group = alike_sensors(model, rows)
    assert group[0] == group[1] == group[2]
    assert group[3] != group[0]


def test_only_a_play_before_the_sensor_asks_for_corrected_states() -> None:
    model = MODEL.with_effects([*MODEL.effects, "backlash"])
    names, rows = list(model.parameters), np.tile(model.values, (4, 1))
    rows[:, [names.index("backlash.gap"), names.index("backlash.load_share")]] = [
        [0.0, 0.0],
        [0.0, 0.2],
        [1e-4, 0.0],
        [1e-4, 0.2],
    ]
    assert sensing(model, rows).tolist() == [False, False, True, True]


def test_only_sensors_with_states_of_their_own_have_to_be_driven() -> None:
    """A gain or an offset is taken back at once."""
    names, rows = list(LATE.parameters), np.tile(LATE.values, (3, 1))
    delay, offset = (
        [names.index(f"{effect}.{key}") for key in keys]
        for effect, keys in (
            ("position_sensor_delay", ("delay", "low_pass")), ("pressure_sensor_offset", ("offset_a", "offset_b")),
        )
    )  # fmt: skip
    rows[:2, delay] = 0.0
    rows[0, offset] = 0.0
    assert sensing(LATE, rows).tolist() == [False, True, True]
    assert must_drive(LATE, rows).tolist() == [False, False, True]


def test_along_corrected_states_a_machine_has_true_sensors_unless_it_reads_them(tmp_path: Path) -> None:
    """A servo's position loop follows the late position, not the true one."""
    rows = variants(LATE)
    plain = unsensed(LATE, rows)
    moved = {name for name, x, y in zip(LATE.parameters, rows[0], plain[0], strict=True) if x != y}
    assert moved == {
        "position_sensor_delay.delay", "pressure_sensor_offset.offset_a", "pressure_sensor_offset.offset_b",
    }  # fmt: skip
    assert not sensing(LATE, plain).any()
    (tmp_path / "servo.yaml").write_text(SERVO)
    servo = load_model(tmp_path / "servo.yaml")
    late = servo.with_effects([*servo.effects, "position_sensor_delay"])
    values = late.values[None]
    assert unsensed(late, values) is values


def test_a_wrong_gain_is_taken_back_exactly() -> None:
    """Twice through the fixed point, as with states that are driven, left a millionth of the pressure."""
    wrong = {"pressure_sensor_gain.error_a": 0.05, "pressure_sensor_gain.error_b": 0.0}
    model = MODEL.with_effects([*MODEL.effects, "pressure_sensor_gain"], wrong)
    frame = frame_of(RUN, model.chambers)
    (found,) = follow_each(model, frame, model.values[None])
    np.testing.assert_allclose(1.05 * found.frame[:, 2], frame.states[:, 2], rtol=1e-7)
    np.testing.assert_array_equal(found.frame[:, [0, 1, 3]], frame.states[:, [0, 1, 3]])


def test_a_variant_gives_the_same_alone_and_beside_others() -> None:
    rows = variants(LATE)
    for k, (states, mean) in driven(rows).items():
        [(alone, alone_mean)] = driven(rows[k : k + 1]).values()
        assert np.array_equal(states, alone)
        assert np.array_equal(mean, alone_mean)


def test_effects_with_states_of_their_own_stay_finite_at_100_hz() -> None:
    """Spool, line and sensor delay swing at 1000 to 1732 rad/s where they are neutral; parts of samples take 5 ms."""
    model, _, run = own("steps", sample_time=0.01, seconds=3.0)
    swinging = ("line_delay", "position_sensor_delay", "valve_spool_dynamics")
    neutral = {
        "line_delay.delay": 0.0,
        "position_sensor_delay.delay": 0.0,
        "valve_spool_dynamics.angular_frequency": 1e3,
    }
    slow = model.with_effects([*model.effects, *swinging], neutral)
    (alone,) = follow_each(model, frame_of(run, model.chambers), model.values[None])
    (beside,) = follow_each(slow, frame_of(run, slow.chambers), slow.values[None])
    np.testing.assert_allclose(beside.claimed, alone.claimed, rtol=1e-6, atol=1e-6 * np.abs(alone.claimed).max())
