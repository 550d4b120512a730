"""The control files that ship are what the laws' defaults say, so that neither grows stale."""

from importlib.resources import files

import yaml

from pneumo_ros.control import Pid, ValveInverse


def test_pid_yaml_holds_the_defaults() -> None:
    text = (files("pneumo_ros.config") / "control" / "pid.yaml").read_text(encoding="utf-8")
    given = yaml.safe_load(text)["/**"]["ros__parameters"]
    assert given["pid"] == {name: gain.default for name, gain in Pid.gains.items()}
    assert given["valve"] == {"smoothing": ValveInverse().smoothing}
    assert given["law"] == "pid"
    for name, gain in Pid.gains.items():
        line = next(line for line in text.splitlines() if line.strip().startswith(f"{name}:"))
        assert f"[{gain.unit}] {gain.meaning}" in line
