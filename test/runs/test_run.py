"""Recordings on a uniform grid: rate, gaps, inputs between samples, and refusals."""

from pathlib import Path

import numpy as np
import pytest
from identify.making import recording, recording_of, rig
from rig import bags

from pneumo_ros.errors import DataError
from pneumo_ros.plant import load_model
from pneumo_ros.records import Recording, read_recording
from pneumo_ros.runs.run import PARTS, check_position, make_run

N = 2000
TIME = np.arange(N) * 1e-3


def valve_driven(time: np.ndarray = TIME, **changes: object) -> Recording:
    """A plain recording at the given times."""
    n = len(time)
    signals: dict[str, object] = {
        "time": time,
        "position": 0.1 + 0.05 * time,
        "pressure_a": np.full(n, 3e5),
        "pressure_b": np.full(n, 4e5),
        "voltage": np.zeros(n),
        "command_time": np.array([-0.001]),
        "command": np.array([0.0]),
    }
    return recording(**(signals | changes))


@pytest.mark.parametrize("jitter", [1e-5, 2e-4])
def test_jitter_does_not_change_the_rate(jitter: float) -> None:
    time = TIME + np.random.default_rng(0).uniform(-jitter, jitter, N)
    run = make_run(valve_driven(time - time[0]))
    assert len(run) == N
    assert run.sample_time == pytest.approx(1e-3, abs=2.0 * jitter / N)
    assert run.measured.all()
    np.testing.assert_allclose(
        run.position, np.interp(run.time, time - time[0], 0.1 + 0.05 * (time - time[0])), atol=1e-12
    )


def test_a_lost_sample_is_bridged_and_a_gap_is_masked() -> None:
    keep = np.ones(N, dtype=bool)
    keep[500] = keep[1000:1100] = False
    run = make_run(valve_driven(TIME[keep]))
    assert len(run) == N
    assert run.sample_time == pytest.approx(1e-3)
    assert run.measured[:1000].all()
    assert not run.measured[1002:1098].any()
    assert run.measured[1100:].all()
    np.testing.assert_allclose(run.position, 0.1 + 0.05 * TIME, atol=1e-12)


def test_a_command_between_two_samples_acts_at_its_tenth() -> None:
    commands = {"command_time": np.array([-0.001, 0.10034, 0.2]), "command": np.array([0.5, 2.0, -1.0])}
    run = make_run(valve_driven(**commands))
    assert run.input.shape == ((N - 1) * PARTS,)
    changes = np.flatnonzero(np.diff(run.input)) + 1
    np.testing.assert_array_equal(changes, [1003, 2000])
    np.testing.assert_array_equal(run.input[[0, 1002, 1003, 1999, 2000, -1]], [0.5, 0.5, 2.0, 2.0, -1.0, -1.0])
    assert run.held[100] == pytest.approx(0.3 * 0.5 + 0.7 * 2.0)


def test_before_the_first_command_the_first_one_is_taken() -> None:
    run = make_run(valve_driven(command_time=np.array([0.05]), command=np.array([1.5])))
    assert (run.input == 1.5).all()


def test_a_second_command_is_held_like_the_first() -> None:
    changes = {"command_b_time": TIME[[0, 30]] + 5e-4, "command_b": np.array([5.0, 7.0])}
    held = make_run(valve_driven(**changes)).further["U_b"]
    assert (held[:305] == 5.0).all()
    assert (held[305:] == 7.0).all()


def test_signals_have_the_names_of_reports() -> None:
    assert list(make_run(valve_driven()).signals) == ["position_m", "pressure_a_pa", "pressure_b_pa"]


def test_a_measured_force_is_linear_between_samples() -> None:
    force = np.random.default_rng(0).normal(0.0, 10.0, N)
    run = make_run(recording(time=TIME, position=np.zeros(N), effort=force))
    assert run.force_driven
    assert list(run.signals) == ["position_m"]
    np.testing.assert_allclose(run.held, 0.5 * (force[1:] + force[:-1]), atol=1e-9)
    np.testing.assert_allclose(run.force, force[:-1], atol=1e-9)


def test_a_recording_of_either_kind_can_be_taken_as_force_driven() -> None:
    force = np.linspace(0.0, 5.0, N)
    run = make_run(valve_driven(effort=force), force_driven=True)
    assert run.force_driven
    np.testing.assert_allclose(run.force, force[:-1], atol=1e-9)


def test_a_bag_of_the_rig_gives_the_run_of_its_arrays(tmp_path: Path) -> None:
    _, recorded, expected = rig("constant_p1100")
    bags.write(tmp_path / "constant_p1100", recorded, 1_700_000_000 * 10**9)
    run = make_run(read_recording(tmp_path / "constant_p1100"))
    assert run.sample_time == pytest.approx(expected.sample_time, rel=1e-9)
    for name, signal in expected.signals.items():
        np.testing.assert_allclose(run.signals[name], signal, rtol=1e-12)
    np.testing.assert_array_equal(run.input, expected.input)


def test_the_grid_follows_the_true_samples() -> None:
    """The rig samples on the millisecond and stamps with 10 us of jitter: the run may differ by that motion."""
    _, recorded, run = rig("train_steps")
    truth = recorded.truth[:, 0]
    assert len(run) == len(truth)
    assert np.std(run.position - truth) < 6.5e-6
    assert make_run(recording_of(recorded)).sample_time == pytest.approx(1e-3, rel=1e-5)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"time": TIME[:49]}, "holds 49 samples; at least 50"),
        ({"time": np.arange(200) * 0.1}, "sampled every 100 ms"),
        ({"pressure_a": np.full(N, 1500.0)}, "chamber_a/pressure is 1500 to 1500 in 2000 samples: its sensor gives no"),
        ({"pressure_b": np.linspace(-3e3, 2e5, N)}, "chamber_b/pressure falls to -3000 Pa at 0.000 s.*--read-as gauge"),
        ({"pressure_a": None}, "no chamber_a/pressure"),
        ({"voltage": None}, "no valve command"),
    ],
)
def test_what_is_refused(changes: dict[str, object], words: str) -> None:
    with pytest.raises(DataError, match=words):
        make_run(valve_driven(**changes), force_driven=False)


def test_a_force_is_needed_where_it_drives() -> None:
    with pytest.raises(DataError, match="has no effort"):
        make_run(valve_driven(), force_driven=True)


def test_positions_outside_the_stroke_are_refused() -> None:
    """Millimetres, most of the time."""
    run = make_run(valve_driven(position=1e3 * (0.1 + 0.05 * TIME)))
    with pytest.raises(
        DataError, match=r"run: the position is 200 m at 1\.999 s, outside the stroke of axis, -1 to 1 m"
    ):
        check_position(load_model(), run)


def test_a_stop_may_give_way_by_a_twentieth_of_the_half_stroke() -> None:
    check_position(load_model(), make_run(valve_driven(position=np.linspace(0.0, 1.049, N))))
    with pytest.raises(DataError, match=r"outside the stroke of axis"):
        check_position(load_model(), make_run(valve_driven(position=np.linspace(0.0, 1.06, N))))
