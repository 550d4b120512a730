"""Commissioning of simulated rigs: wiring, safe moves, predictions of what a move tells, and what comes out."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from pneumo_ros.commission import moves
from pneumo_ros.commission.commission import Commissioned, Commissioning
from pneumo_ros.commission.information import Told, begun, knowledge, shrinkage
from pneumo_ros.commission.performing import Performed
from pneumo_ros.commission.safe import LATE, again, agreeing, safe, unmoved
from pneumo_ros.commission.simulated import SimulatedRig
from pneumo_ros.commission.summary import errors, summary
from pneumo_ros.commission.wiring import UnmovedError, find_wiring
from pneumo_ros.errors import DataError
from pneumo_ros.experiment.catalogue import make_programme
from pneumo_ros.experiment.plumbing import plumbing
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.rehearsal import rehearse
from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import Model, load_model
from pneumo_ros.records.corrections import wiring

WISHES = Wishes(supply="6barg", mass="2", bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min")
OFF = {
    "arctan_flow.voltage_gain": 1.3, "lugre_friction.coulomb_friction": 1.2, "lugre_friction.static_friction": 1.2,
    "chambers.volume_a": 1.05, "chambers.volume_b": 1.1,
}  # fmt: skip


@pytest.fixture(scope="module")
def sheet() -> Model:
    """The machine as data sheets tell it."""
    return design(WISHES, load_shelf([])).model


@pytest.fixture(scope="module")
def truth(sheet: Model) -> Model:
    """The machine as it is."""
    return sheet.with_parameters({name: share * sheet[name] for name, share in OFF.items()})


@pytest.mark.parametrize(
    "words",
    [
        (),
        ("swapped-chambers",),
        ("reversed-voltage", "gauge", "bar"),
        ("reversed-position", "mm", "zero=100mm"),
        ("swapped-chambers", "reversed-position", "reversed-voltage"),
        ("swapped-chambers", "reversed-voltage", "gauge", "kPa", "mm", "zero=-100mm"),
    ],
)
def test_ten_seconds_tell_the_wiring(sheet: Model, truth: Model, words: tuple[str, ...]) -> None:
    sensors = tuple(word for word in words if word in ("gauge", "bar", "kPa"))
    rig = SimulatedRig(truth, words, position=0.02)
    job = Commissioning(sheet, rig.perform, sensors=sensors)
    found = job.wiring()
    assert set(found.words) == set(words)
    assert found.certain
    assert set(found.faults) == {word for word in words if word.startswith(("swapped", "reversed"))}
    assert job.moves[0].seconds < 15.0


@pytest.mark.parametrize(
    "limits",
    [
        {"dead_zone.right_limit": 0.3, "dead_zone.left_limit": 0.03},
        {"dead_zone.right_limit": 0.8, "dead_zone.left_limit": 0.8, "arctan_flow.voltage_gain": 2.0},
    ],
)
def test_ten_seconds_tell_a_dead_zone_unlike_that_of_the_data_sheet(
    sheet: Model, truth: Model, limits: dict[str, float]
) -> None:
    """Within the dead zone of the data sheet, 0.2 V, a fit sees no slope: it begins with one that commands leave."""
    job = Commissioning(sheet, SimulatedRig(truth.with_parameters(limits)).perform, sensors=())
    job.wiring()
    slow = [replace(run, input=np.clip(run.input, -0.1, 0.5)) for run in job.runs]
    starts = begun(sheet, slow)
    assert sorted({one["dead_zone.left_limit"] for one in starts}) == pytest.approx([0.095])
    assert sorted({one["dead_zone.right_limit"] for one in starts}) == pytest.approx(
        [0.2, 0.95 * max(run.held.max() for run in slow)]
    )
    for name, volts in limits.items():
        if name.startswith("dead_zone"):
            assert job.known.model[name] == pytest.approx(volts, abs=0.02)
            assert job.known.deviations[name] < 0.02


def test_a_valve_that_opens_late_is_no_other_zero_of_the_encoder(sheet: Model) -> None:
    """Ramps end where the piston moves: 8 % above the dead zone here, where no fit began once.

    A zero at the end of the stroke with twice the volume then explained the ramps best, and the piston was sent there.
    """
    late = {
        "chambers.volume_a": 6.34e-5, "chambers.volume_b": 5.326e-5, "dead_zone.right_limit": 0.8875,
        "dead_zone.left_limit": 0.8875, "arctan_flow.voltage_gain": 2.152, "choked_flow.conductance_filling": 3.261e-8,
        "choked_flow.conductance_exhaust": 2.71e-8, "choked_flow.critical_ratio": 0.2129,
        "lugre_friction.static_friction": 82.02, "lugre_friction.coulomb_friction": 41.48,
        "lugre_friction.stribeck_velocity": 0.01399, "lugre_friction.bristle_stiffness": 1.39e6,
    }  # fmt: skip
    rig = SimulatedRig(sheet.with_parameters(late), seed=3171, position=0.018)
    job = Commissioning(sheet, rig.perform, sensors=())
    assert job.wiring().words == ()
    assert job.known.model["dead_zone.right_limit"] == pytest.approx(0.8875, abs=1e-3)
    assert job.known.model["chambers.volume_a"] == pytest.approx(6.34e-5, rel=0.15)


def test_machines_as_they_may_be_open_where_the_recordings_say() -> None:
    """Dead zone and null offset are known to half a volt each, and the voltages at which the valve opens exactly.

    Drawn each by itself, they were rehearsed on valves open by half a volt at rest, and no move seemed safe.
    """
    names = "valve_null_offset.offset", "dead_zone.right_limit", "dead_zone.left_limit"
    axis = load_model("axis")
    model = axis.with_effects([*axis.effects, "valve_null_offset"], {names[0]: 0.1})
    way = np.array([1.0, 1.0, -1.0])
    found = moves.drawn(model, dict.fromkeys(names, 0.5), 20, correlation=np.outer(way, way))
    offset, right, left = np.array([[one[name] for name in names] for one in found]).T
    assert len(found) == 20
    assert np.ptp(offset) > 0.5
    assert right - offset == pytest.approx(0.68)
    assert left + offset == pytest.approx(0.88)
    assert min(right.min(), left.min()) > 0.0  # what would not stay in its range is drawn anew


def test_voltages_shrink_towards_the_dead_zone_of_their_side(sheet: Model) -> None:
    narrow, wide = (
        sheet.with_parameters({"dead_zone.right_limit": right, "dead_zone.left_limit": left})
        for right, left in ((0.3, 0.05), (0.5, 0.1))
    )
    dead = moves.narrowest([wide, narrow])
    made = moves.smaller(moves.static(sheet), dead, 0.01)
    ends = [trial.voltage.largest for trial in made.trials]
    assert dead == (0.3, 0.05)
    assert ends == pytest.approx([0.3, 0.05] * 3, abs=0.02)


def test_a_closed_signal_that_is_known_is_not_guessed(sheet: Model, truth: Model) -> None:
    """4.6 V is the middle of no usual range."""
    rig = SimulatedRig(truth, ("closed=4.6V", "reversed-voltage"))
    found = Commissioning(sheet, rig.perform, ("closed=4.6V",), ()).wiring()
    assert set(found.words) == {"closed=4.6V", "reversed-voltage"}


def test_a_command_is_sent_and_a_position_read_as_the_words_say() -> None:
    wired = wiring(("mm", "zero=100mm", "reversed-position", "reversed-voltage", "closed=5V"))
    assert wired.position(120.0) == pytest.approx(-0.02)
    assert wired.command(2.0) == pytest.approx(3.0)


def test_a_dead_sensor_and_a_piston_that_stays_are_named(sheet: Model, truth: Model) -> None:
    done = SimulatedRig(truth).perform(plumbing(sheet), (), "plumbing")
    (recording,) = done.recordings
    with pytest.raises(DataError, match="chamber_b/pressure never changes"):
        find_wiring([replace(recording, pressure_b=np.full(len(recording), 1e5))], sheet)
    with pytest.raises(DataError, match="the position never changes"):
        find_wiring([replace(recording, position=np.zeros(len(recording)))], sheet)
    with pytest.raises(UnmovedError, match="is the supply pressure on"):
        find_wiring([replace(recording, position=0.01 * recording.position)], sheet)


def test_a_piston_that_stays_is_pushed_harder(sheet: Model, truth: Model) -> None:
    rig, largest, said = SimulatedRig(truth), list[float](), list[str]()

    def perform(programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        done = rig.perform(programme, words, name)
        largest.append(programme.trials[0].voltage.largest)
        still = tuple(replace(one, position=0.01 * one.position) for one in done.recordings)
        return replace(done, recordings=still) if len(largest) == 1 else done

    Commissioning(sheet, perform, sensors=(), tell=said.append).wiring()
    assert largest[0] < largest[1]
    assert "tried again with larger ones" in said[0]


def test_moves_are_made_small_enough_for_every_machine_that_may_be(sheet: Model) -> None:
    wide = {"arctan_flow.voltage_gain": 0.02, "lugre_friction.coulomb_friction": 3.0}
    machines = [sheet, *moves.drawn(sheet, wide, 4, 3)]
    programme = moves.dynamic(sheet)
    assert any("end stop" in rehearse(programme, one).aborted for one in machines)
    made = safe(programme, machines)
    assert made is not None
    assert not any("end stop" in rehearse(made, one).aborted for one in machines)
    assert made.trials[0].voltage.largest < programme.trials[0].voltage.largest


def test_a_trial_that_reaches_the_limit_is_tried_smaller(sheet: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    """By as much as is safe for a machine that reaches it, too."""
    brisk = sheet.with_parameters(
        {
            "arctan_flow.voltage_gain": 0.2,
            "lugre_friction.coulomb_friction": 15.0,
            "lugre_friction.static_friction": 20.0,
        }
    )
    rig, tried = SimulatedRig(brisk), []

    def perform(programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        tried.append((name, programme.trials[0].voltage.largest))
        if len(tried) == 1:
            return Performed((), 1.0, "the piston has reached the end stop, +0.100 m (end: 0.099 m)")
        return rig.perform(programme, words, name)

    job = Commissioning(sheet, perform, sensors=())
    monkeypatch.setattr(job, "_otherwise", lambda: [sheet, brisk])
    job._take("static", moves.static(sheet))
    assert [name for name, _ in tried] == ["00_static", "00_static_1"]
    assert tried[1][1] < tried[0][1]


def test_no_trial_goes_far_beyond_what_was_sent_before(sheet: Model) -> None:
    """A valve that opens thirteen times as fast as the data sheet's, beyond a narrow dead zone: it is felt out.

    A fit to slow trials holds it for less steep than it is.
    """
    values = {
        "arctan_flow.voltage_gain": 1.368, "dead_zone.right_limit": 0.098, "dead_zone.left_limit": 0.098,
        "choked_flow.conductance_filling": 3.14e-8, "choked_flow.conductance_exhaust": 2.9e-8,
        "lugre_friction.static_friction": 50.6, "lugre_friction.coulomb_friction": 32.8,
        "lugre_friction.stribeck_velocity": 0.018, "lugre_friction.bristle_stiffness": 8.74e5,
    }  # fmt: skip
    rig, sent = SimulatedRig(sheet.with_parameters(values), seed=4020), list[tuple[str, float]]()

    def perform(programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        sent.append((name.partition("_")[2], max(one.voltage.largest for one in programme.trials)))
        return rig.perform(programme, words, name)

    job = Commissioning(sheet, perform, sensors=())
    job.wiring()
    job.basics()
    assert [name for name, _ in sent] == ["wiring", "static", "dynamic"]
    assert [len(move.recordings) for move in job.moves[1:]] == [6, 2]
    reached = 0.0
    for _, volts in sent[1:]:
        assert volts < 0.25
        assert reached == 0.0 or volts - 0.098 < 3.5 * reached
        reached = max(reached, volts - 0.098)
    assert rig.farthest < 0.095


def test_larger_voltages_are_rehearsed_and_only_those_of_the_way_back_grow(sheet: Model) -> None:
    reason, machines, programme = "at +0.50 V the piston stays at +0.070 m", [sheet], moves.static(sheet)
    starts = (programme.low, 0.0, programme.high)
    places = list(itertools.product(machines, starts))
    tried = again(programme, reason, machines)
    assert tried is not None
    assert tried.return_right > programme.return_right
    assert tried.return_left > programme.return_left
    assert tried.trials == programme.trials
    assert not any("end stop" in rehearse(tried, one, y, LATE).aborted for one, y in places)


def test_a_retry_is_rehearsed_on_machines_that_would_have_stayed_too(sheet: Model) -> None:
    """A fit may hold a dead zone for narrow that is wide: then the piston stays, and the fit says nothing of it."""
    programme = moves.static(sheet)
    wide = sheet.with_parameters({"dead_zone.right_limit": 0.9, "dead_zone.left_limit": 0.9})
    reason = "at -0.50 V the piston stays at +0.013 m"
    assert agreeing(programme, reason, [sheet, wide, sheet], 5) == [wide]
    assert again(programme, reason, []) is None
    tried = again(programme, reason, [wide])
    assert tried is not None
    assert tried.return_left > programme.return_left


def test_what_is_not_safe_is_not_tried_again(sheet: Model, truth: Model, monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine that may be a jet: the trial ends with what was recorded, and nothing more is sent."""
    rig, sent, said = SimulatedRig(truth), list[Programme](), list[str]()

    def perform(programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        sent.append(programme)
        done = rig.perform(replace(programme, trials=programme.trials[:2]), words, name)
        return replace(done, reason="at +0.50 V the piston stays at +0.070 m")

    job = Commissioning(sheet, perform, sensors=(), tell=said.append)
    jet = sheet.with_parameters({"arctan_flow.voltage_gain": 2.0, "lugre_friction.static_friction": 200.0})
    monkeypatch.setattr(job, "_otherwise", lambda: [jet])
    programme = moves.static(sheet)
    assert again(programme, "the piston stays at", [jet]) is None
    done = job._performed(programme, "static")
    assert len(sent) == 1
    assert len(done.recordings) == 2
    assert "no other voltages are safe" in said[0]


def test_a_move_that_ends_after_its_last_trial_is_not_tried_again(sheet: Model, truth: Model) -> None:
    """On the way back the piston stays: all trials are recorded, and none is left to try."""
    rig, sent = SimulatedRig(truth), list[Programme]()

    def perform(programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        sent.append(programme)
        return replace(rig.perform(programme, words, name), reason="at +0.50 V the piston stays at +0.070 m")

    programme = replace(moves.static(sheet), trials=moves.static(sheet).trials[:2])
    done = Commissioning(sheet, perform, sensors=())._performed(programme, "static")
    assert len(sent) == 1
    assert len(done.recordings) == 2
    assert "stays" in done.reason


def test_a_move_at_which_the_piston_stays_ends_no_commissioning(
    sheet: Model, truth: Model, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is left out from then on, says so, and its time counts; the other moves go on."""
    rig, made, said = SimulatedRig(truth), list[str](), list[str]()

    def perform(programme: Programme, words: tuple[str, ...], name: str) -> Performed:
        if "creep" in name or "static" in name:
            return Performed((), 7.0, "at +0.22 V the piston stays at +0.013 m; is the supply on?")
        return rig.perform(programme, words, name)

    job = Commissioning(sheet, perform, sensors=(), tell=said.append)
    monkeypatch.setattr(job, "_otherwise", list[Model])  # none that would have stayed: no other voltages are safe
    monkeypatch.setattr(job, "_learn", lambda name, done: made.append(name))
    job.basics()
    assert made == ["dynamic"]
    creep = next(one for one in moves.candidates(sheet, seed=1) if one.experiment == "creep")
    assert not job._taken("creep", creep)
    assert [(move.name, move.seconds) for move in job.moves] == [("static", 7.0), ("creep", 7.0)]
    assert sum("left out" in text for text in said) == 2
    tried: list[str] = []
    monkeypatch.setattr("pneumo_ros.commission.commission.safe", lambda one, *_: tried.append(one.experiment))
    assert job.best_move()[1] is None
    assert "creep" not in tried
    assert {"slow-strokes", "wide-strokes", "wide-open"} <= {*tried}


def test_the_menu_creeps_and_opens_wide(sheet: Model) -> None:
    """15 mV beyond the dead zone of each side, where friction is that of rest, and as far as the valve opens."""
    uneven = sheet.with_parameters({"dead_zone.right_limit": 0.3, "dead_zone.left_limit": 0.1})
    menu = {one.experiment: one for one in moves.candidates(uneven, seed=1)}
    assert [trial.voltage.largest for trial in menu["creep"].trials] == pytest.approx([0.315, 0.115])
    assert [trial.voltage.largest for trial in menu["wide-open"].trials] == pytest.approx([6.5, 6.3])
    assert [trial.direction for trial in menu["creep"].trials] == [1, -1]
    wide, usual = (menu[name].trials[0].travel for name in ("wide-strokes", "strokes"))
    assert wide == pytest.approx(2.0 * menu["strokes"].high)
    assert wide >= usual


def test_a_move_is_worth_what_it_tells_of_each_parameter() -> None:
    """A ratio of two parameters that is known better still narrows neither of them."""

    def tells(*slopes: list[float]) -> Told:
        rows = np.array(slopes)
        return Told(rows, np.zeros(len(rows)), np.zeros(len(rows), dtype=np.int64), {})

    known = tells([100.0, -100.0])
    ratio, one = tells([300.0, -300.0]), tells([2.0, 0.0])
    assert shrinkage(known, ratio, 60.0) < 1e-3
    assert shrinkage(known, one, 60.0) > 0.3
    assert shrinkage(known, one, 30.0) > shrinkage(known, one, 60.0)


def test_ramps_are_rehearsed_though_they_know_no_position(sheet: Model) -> None:
    """A piston that jumps farther than half the stroke is moved by smaller ramps, or by none."""
    strong = plumbing(sheet, stronger=4.0)
    assert safe(strong, [sheet]) == strong
    far = rehearse(strong, sheet, sample=LATE).farthest
    assert 0.0 < far < 0.1
    near = replace(strong, end=0.9 * far, low=-0.3 * far, high=0.3 * far)
    made = safe(near, [sheet])
    assert made is not None
    assert made.trials[0].voltage.largest < strong.trials[0].voltage.largest
    stuck = sheet.with_parameters({"lugre_friction.static_friction": 400.0})
    assert unmoved(strong, [sheet, stuck], 0.004) == [stuck]


@pytest.fixture(scope="module")
def commissioned(sheet: Model, truth: Model) -> tuple[Commissioned, SimulatedRig, list[str]]:
    """A commissioning of less than a minute, with moves of 5 s: the last fit of all runs takes most of its time."""
    rig, said = SimulatedRig(truth, ("gauge", "bar")), list[str]()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(moves, "SECONDS", 5.0)
        found = Commissioning(sheet, rig.perform, (), ("gauge", "bar"), 0.85, said.append).run()
    return found, rig, said


def test_the_machine_is_found_with_intervals(commissioned: tuple[Commissioned, SimulatedRig, list[str]]) -> None:
    found, rig, _ = commissioned
    assert rig.farthest < 0.1
    known = found.knowledge.estimates
    assert (
        abs(found.machine["lugre_friction.coulomb_friction"] / rig.truth["lugre_friction.coulomb_friction"] - 1) < 0.02
    )
    assert abs(found.machine["chambers.volume_b"] / rig.truth["chambers.volume_b"] - 1) < 0.005
    for name, one in known.items():
        if one.determined:
            assert one.std < 0.5 * one.prior
            assert one.low - one.std < rig.truth[name] < one.high + one.std, name
    assert found.machine.uncertainty["chambers.volume_a"] == pytest.approx(known["chambers.volume_a"].std)


def test_what_a_move_tells_is_predicted(commissioned: tuple[Commissioned, SimulatedRig, list[str]]) -> None:
    found, _, said = commissioned
    ratios = [move.ratio for move in found.moves if move.predicted]
    assert ratios
    assert all(1.0 / 1.5 < ratio < 1.5 for ratio in ratios)
    assert any("another minute" in text for text in said)
    assert found.left > 0.0


def test_a_level_that_only_the_prior_tells_is_as_uncertain_as_it(
    commissioned: tuple[Commissioned, SimulatedRig, list[str]],
) -> None:
    """Both slopes and the gain act as a product: their common level has the prior's deviation over root 2 at least."""
    known = commissioned[0].knowledge.estimates
    for name in ("dead_zone.right_slope", "dead_zone.left_slope"):
        assert known[name].std > 0.95 * known[name].prior / np.sqrt(2.0)


def test_its_summary_is_plain_data(commissioned: tuple[Commissioned, SimulatedRig, list[str]]) -> None:
    found = commissioned[0]
    told = summary(found)
    assert told["seconds"] == pytest.approx(sum(move["seconds"] for move in told["moves"]))
    assert told["parameters"]["chambers.volume_a"]["unit"] == "m3"
    before, after = errors(found)
    assert after < 0.2 * before


def test_without_runs_data_sheets_are_all_that_is_known(sheet: Model) -> None:
    known = knowledge(sheet, ())
    name = "lugre_friction.coulomb_friction"
    assert known.deviations[name] == sheet.uncertainty[name]
    assert known.model is sheet


def test_a_valve_that_closes_at_5_v_gets_no_more_than_its_range(sheet: Model, truth: Model) -> None:
    """Moves are planned about the closed signal: no 10 V beside 5 V, and swapped hoses mirror it there."""
    offset = {"valve_null_offset.offset": -5.0}
    behind, real = (one.with_effects(["valve_null_offset", *one.effects], offset) for one in (sheet, truth))
    for one in [moves.static(behind), moves.dynamic(behind), *moves.candidates(behind, seed=1)]:
        assert one.closed == 5.0
        assert max(trial.voltage.largest for trial in one.trials) <= 5.0
    programme = make_programme("constant-voltage", behind, (1.0, 9.0))
    assert [trial.voltage.largest for trial in programme.trials] == [1.0, 1.0]
    rig = SimulatedRig(real, ("reversed-voltage", "closed=10V"), position=0.02)
    found = Commissioning(behind, rig.perform, sensors=()).wiring()
    assert set(found.words) == {"reversed-voltage", "closed=10V"}


def test_ramps_stay_about_where_the_piston_stood(sheet: Model, truth: Model) -> None:
    """A piston that coasts farther one way than the other is not taken to an end stop, step by step."""
    for position in (-0.04, 0.0, 0.04):
        rig = SimulatedRig(truth, ("reversed-position",), position=position)
        programme = plumbing(sheet)
        (found,) = rig.perform(programme, (), "plumbing").recordings
        assert rig.farthest < programme.high
        assert np.ptp(found.position) > 0.03
