"""The rig of a live node: what it sends for a voltage at the valve, and when it may send anything."""

from pathlib import Path

import pytest

from pneumo_ros.axis.controller import settings
from pneumo_ros.axis.experiment.preparing import prepare
from pneumo_ros.axis.rig import AS_OPTION, AS_PARAMETER, SETTINGS, live_rig
from pneumo_ros.errors import UsageError

VALUES = {setting.name: setting.default for setting in SETTINGS}


def rig_file(folder: Path, text: str) -> str:
    """The path of a rig file with these entries."""
    path = folder / "rig.yaml"
    path.write_text(f"rig: {text}")
    return str(path)


def test_commands_are_counted_from_the_declared_signal_whoever_declares_it() -> None:
    machine_says = live_rig(VALUES, 5.0, True)
    said_again = live_rig({**VALUES, "closed_signal": "5V"}, 5.0, True)
    only_said = live_rig({**VALUES, "closed_signal": "5V"}, 0.0, False)
    assert machine_says.command(5.0 + 1.0) == said_again.command(5.0 + 1.0) == only_said.command(1.0) == 6.0
    mirrored = live_rig({**VALUES, "closed_signal": "5V", "read_as": "reversed-voltage"}, 5.0, True)
    assert mirrored.command(5.0) == 5.0
    assert mirrored.command(6.0) == 4.0


def test_range_and_safe_state_are_kept(tmp_path: Path) -> None:
    given = {**VALUES, "rig": rig_file(tmp_path, "{closed: 5V, safe: 4.5V, range: 0V..10V}")}
    found = live_rig(given, 0.0, False)
    assert (found.command(7.0), found.command(-7.0), found.safe(0.0)) == (10.0, 0.0, 4.5)
    assert found.room(0.0, 10.0) == 5.0
    assert found.room(0.0, 6.0) == 1.0
    with pytest.raises(UsageError, match=r"closed_signal is 0 V, and rig .* says closed 5 V"):
        live_rig({**given, "closed_signal": "0V"}, 0.0, False)


def test_an_assumed_dead_zone_says_nothing_of_the_closed_signal() -> None:
    """As the machine of a data sheet has it; the controller reads its file as parameters."""
    limits = {"dead_zone.right_limit": 0.2, "dead_zone.left_limit": 0.2}
    known, assumed = ({"uncertainty.dead_zone.right_limit": std, **limits} for std in (0.01, 0.4))
    values = {one.name: one.default for one in settings.SETTINGS} | limits | {"effects": ["dead_zone"]}
    found = [settings.wired_by(values, {"effects": ["dead_zone"], **one}).declared for one in (known, assumed)]
    assert found == [True, False]


def test_a_programme_and_a_controller_keep_to_the_limits_in_their_dimension(tmp_path: Path) -> None:
    """Both plan in m: angles, and a machine that turns, are refused before anything moves."""
    path = rig_file(tmp_path, "{machine: axis, limits: -80mm..60mm}")
    trials = {"rig": path, "programme": "", "model": "", "model_given": False, "experiment": "constant-voltage"}
    trials |= {"output": str(tmp_path / "runs")}
    programme, _ = prepare(trials, ())
    assert (programme.low, programme.high) == (-0.08, 0.06)
    own = {one.name: one.default for one in settings.SETTINGS} | {"rig": path}
    brought = settings.of_a_rig(own, {})
    assert (brought["limits.low"], brought["limits.high"]) == (-0.08, 0.06)
    angles = tmp_path / "angles.yaml"
    angles.write_text("rig: {machine: axis, limits: -6deg..6deg}")
    for refusing in (
        lambda: prepare({**trials, "rig": str(angles)}, ()),
        lambda: settings.of_a_rig({**own, "rig": str(angles)}, {}),
        lambda: settings.of_a_rig({**own, "rig": str(angles)}, {"effects": ["dead_zone"]}),
    ):
        with pytest.raises(UsageError, match=r"limits are angles, -6deg\.\.6deg, and .* moves along a line"):
            refusing()
    vane = tmp_path / "vane.yaml"
    vane.write_text("rig: {machine: vane, limits: -60deg..60deg}")
    with pytest.raises(
        UsageError, match="laws of control plan in m and N; the machine file says 'coordinate: rotation'"
    ):
        settings.of_a_rig({**own, "rig": str(vane)}, {})


def test_nothing_is_sent_until_somebody_has_said_it() -> None:
    silent = live_rig(VALUES, 0.0, False)
    assert silent.refusal(0.0, None) == AS_PARAMETER
    assert silent.refusal(0.0, None, verb=True) == AS_OPTION
    assert silent.refusal(0.0, 0.0) == ""  # a simulator that closes there
    assert "start it with the simulator's machine file" in silent.refusal(0.0, 5.0)
    for said in ({"closed_signal": "0V"}, {"read_as": "closed=0V"}):
        assert live_rig({**VALUES, **said}, 0.0, False).refusal(0.0, None) == ""
