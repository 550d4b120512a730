"""What the identification's own process reads."""

from pathlib import Path

import numpy as np
import pytest
from records.axis_bag import STAMP, TIME, N, streams, write
from records.test_choices import joint_states

from pneumo_ros.errors import DataError
from pneumo_ros.records import encoding
from pneumo_ros.records.contract import JOINT_STATES, PRESSURE_A, PRESSURE_B
from pneumo_ros.ros.identification.work import Report, read


def quiet(share: float, text: str) -> None:
    """Hear nothing."""


def test_the_joint_is_chosen_by_name_where_a_recording_holds_several(tmp_path: Path) -> None:
    rod, content = 0.1 * np.sin(10.0 * TIME), streams()
    content[JOINT_STATES] = (STAMP, joint_states([["arm", "rod"]], np.column_stack([np.zeros(N), rod])))
    for name in (PRESSURE_A, PRESSURE_B):
        content[name] = (STAMP, encoding.pressures(STAMP, 3e5 + 1e4 * np.cos(30.0 * TIME), 9e4))
    path = str(write(tmp_path / "run", content))
    (run,), refused = read([path], "", "rod", Report(), quiet)
    assert not refused
    np.testing.assert_allclose(run.position, rod[: len(run)], atol=1e-4)
    with pytest.raises(DataError, match=r"several joints \(arm, rod\)"):
        read([path], "", "", Report(), quiet)
