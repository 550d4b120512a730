"""The requests that the identification's process reads."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from records.axis_bag import STAMP, TIME, N, streams, write
from records.test_choices import joint_states
from ros.campaign_bags import record_campaign

from pneumo_ros.axis.identification.work import Report, read, work
from pneumo_ros.errors import DataError
from pneumo_ros.plant import load_model
from pneumo_ros.records import encoding, read_recording, write_recording
from pneumo_ros.records.contract import JOINT_STATES, PRESSURE_A, PRESSURE_B

AXIS = load_model("axis")


def quiet(share: float, text: str) -> None:
    """Ignore the message."""


def job(*bags: Path, joint_name: str = "") -> dict[str, Any]:
    """The node's request: identify the default machine from recordings."""
    given = {"bags": [str(bag) for bag in bags], "axis": "", "joint_name": joint_name, "whole_model": False}
    return given | {"machine": AXIS.as_dict(), "name": "axis", "files": []}


def test_the_joint_is_chosen_by_name_where_a_recording_holds_several(tmp_path: Path) -> None:
    rod, content = 0.1 * np.sin(10.0 * TIME), streams()
    content[JOINT_STATES] = (STAMP, joint_states([["arm", "rod"]], np.column_stack([np.zeros(N), rod])))
    for name in (PRESSURE_A, PRESSURE_B):
        content[name] = (STAMP, encoding.pressures(STAMP, 3e5 + 1e4 * np.cos(30.0 * TIME), 9e4))
    path = write(tmp_path / "run", content)
    (run,), refused = read(job(path, joint_name="rod"), AXIS, Report(), quiet)
    assert not refused
    np.testing.assert_allclose(run.position, rod[: len(run)], atol=1e-4)
    with pytest.raises(DataError, match=r"several joints \(arm, rod\)"):
        read(job(path), AXIS, Report(), quiet)


def test_a_recording_with_swapped_chambers_is_refused_with_the_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    good, other = record_campaign(tmp_path, AXIS, (3.0,), 3.0)[:2]
    seen = read_recording(other)
    swapped = tmp_path / "swapped"
    write_recording(
        swapped, time=seen.time, position=seen.position, pressure_a=seen.pressure_b, pressure_b=seen.pressure_a,
        voltage=seen.voltage,
    )  # fmt: skip
    result = work(job(good, swapped), Report())
    assert result["recordings"] == [good.name]
    reason = result["refused_recordings"][str(swapped)]
    assert "chamber_a/pressure and chamber_b/pressure seem to be exchanged" in reason
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {"refused": str(swapped), "reason": reason} in lines
    with pytest.raises(DataError, match=r"none of 1 recordings can be used; the last: .*seem to be exchanged"):
        work(job(swapped), Report())
