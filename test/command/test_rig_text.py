"""The rig file that a verb writes: what another one has said of live work stays in it."""

from dataclasses import replace
from pathlib import Path

from pneumo_ros.command.rig_file import rig_text
from pneumo_ros.plant import load_model
from pneumo_ros.reading.rig_file import read_rig

SAID = """\
rig: {safe: 4.9V, range: 0V..10V, limits: [-60deg, 1rad], topics: {chamber_a/pressure: "/plc/values:data[1]"}}
"""


def test_what_live_work_needs_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "said.yaml"
    path.write_text(SAID)
    said = read_rig(str(path))
    path.write_text(rig_text("vane", "left", "piston", ("bar",), "Made.", load_model("vane"), 5.0, said))
    expected = replace(said, machine="vane", namespace="left", joint="piston", read_as="bar", closed=5.0, topics={})
    assert read_rig(str(path)) == expected


def test_without_limits_the_stroke_stands_there_to_be_made_smaller(tmp_path: Path) -> None:
    text = rig_text("vane", "left", "piston", (), "Made.", load_model("vane"), None)
    path = tmp_path / "rig.yaml"
    path.write_text(text.replace("# limits", "limits"))
    limits = read_rig(str(path)).limits
    assert limits is not None
    assert limits.coordinate == "rotation"
    assert abs(limits.high - 0.5 * load_model("vane")["piston.stroke"]) < 1e-3
    path.write_text(text)
    assert read_rig(str(path)).limits is None
