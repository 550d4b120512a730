"""Command lines of the nodes: what ROS refuses is said in one line."""

import pytest

from pneumo_ros.ros.arguments import parse


def test_a_parameter_file_that_is_not_there_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        parse("simulator", "Simulate.", [], ["--ros-args", "--params-file", "nothere.yaml"])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "simulator: error: ROS arguments are refused" in said
    assert "nothere.yaml" in said
