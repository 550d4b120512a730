"""Rig files: what they say, what is refused, and which words make a machine's valve close at a declared signal."""

import math
from pathlib import Path

import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.reading.rig_file import Rig, Travel, read_rig, reading_of, with_closed
from pneumo_ros.units import LINE, TURN

WHOLE = """\
rig:
  machine: my.yaml
  read_as: bar,gauge
  closed: 5V
  safe: 4900mV
  range: 0V..10V
  limits: -80mm..0.08
  topics: {joint_states: /plc/encoder}
"""


def test_every_entry_is_read_in_si_units(tmp_path: Path) -> None:
    (tmp_path / "rig.yaml").write_text(WHOLE)
    assert read_rig(str(tmp_path / "rig.yaml")) == Rig(
        machine="my.yaml", read_as="bar,gauge", closed=5.0, safe=4.9, range=(0.0, 10.0),
        limits=Travel(-0.08, 0.08, "translation"), topics={"joint_states": "/plc/encoder"},
    )  # fmt: skip
    (tmp_path / "my.yaml").write_text("")
    assert read_rig(str(tmp_path / "rig.yaml")).machine == str(tmp_path / "my.yaml")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{closed: five}", "closed is 'five'; it takes a number with its unit, such as 5V"),
        ("{closed: 5 bar}", "closed is '5 bar'"),
        ("{closed: .nan}", "closed is nan"),
        ("{safe: true}", "safe is True"),
        ("{range: 10V}", "range is '10V'; it takes two ends, such as 0V..10V"),
        ("{range: 10V..0V}", "the first end must be below the second"),
        ("{closed: 5V, range: 6V..10V}", "closed is 5 V, outside of the range of 6 to 10 V"),
        ("{limits: [1, 2, 3]}", "it takes two ends"),
        (
            "{limits: -80mm..60deg}",
            "'-80mm..60deg', a length and an angle; it takes two of one, such as -80mm..80mm or",
        ),
        (
            "{limits: -80bar..80bar}",
            "limits is '-80bar'; it takes a number with its unit, such as -80mm..80mm or -60deg",
        ),
        ("{topics: {joint_state: /a}}", "did you mean joint_states"),
        ("{topics: /a}", "topics is '/a'"),
    ],
)
def test_what_is_no_entry_is_named_with_an_example(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "rig.yaml").write_text(f"rig: {text}")
    with pytest.raises(UsageError, match=words):
        read_rig(str(tmp_path / "rig.yaml"))


@pytest.mark.parametrize(
    ("text", "ends", "coordinate"),
    [
        ("-80mm..80mm", (-0.08, 0.08), LINE),
        ("[-8cm, 0.08]", (-0.08, 0.08), LINE),
        ("-180deg..0.5 rev", (-math.pi, math.pi), TURN),
        ("-500mrad..1rad", (-0.5, 1.0), TURN),
        ("-1..1", (-1.0, 1.0), ""),
    ],
)
def test_limits_keep_their_dimension(tmp_path: Path, text: str, ends: tuple[float, float], coordinate: str) -> None:
    (tmp_path / "rig.yaml").write_text(f"rig: {{limits: {text}}}")
    limits = read_rig(str(tmp_path / "rig.yaml")).limits
    assert limits is not None
    assert (limits.low, limits.high) == pytest.approx(ends, rel=1e-12)
    assert limits.coordinate == coordinate
    for machine in (LINE, TURN):
        if coordinate in ("", machine):
            assert limits.along(machine, "mine") == (limits.low, limits.high)


def test_limits_of_another_dimension_than_the_machines_are_refused(tmp_path: Path) -> None:
    line, vane, path = load_model("axis"), load_model("vane"), tmp_path / "rig.yaml"
    path.write_text("rig: {limits: -30deg..30deg}")
    angles = read_rig(str(path))
    reading_of(angles, vane)
    said = (
        r"are angles, -30deg\.\.30deg, and axis moves along a line: its limits are in m, mm, cm, in\. Write limits: -80"
    )
    with pytest.raises(UsageError, match=said):
        reading_of(angles, line)
    path.write_text("rig: {limits: -80mm..80mm}")
    lengths = read_rig(str(path))
    reading_of(lengths, line)
    with pytest.raises(
        UsageError, match=r"are lengths, .* and vane turns: .* rad, deg, mrad, rev\. Write limits: -60deg"
    ):
        reading_of(lengths, vane)


def test_a_declared_signal_is_counted_once() -> None:
    assert with_closed((), None, 5.0) == ()
    assert with_closed((), 5.0, 0.0) == ("closed=5V",)
    assert with_closed((), 5.0, 5.0) == ()
    assert with_closed((), 5.0, 4.8) == ()  # the valve's own zero, as it was identified
    assert with_closed(("reversed-voltage",), 5.0, 5.0) == ("reversed-voltage", "closed=10V")
    assert with_closed(("closed=5V",), 5.0, 0.0) == ("closed=5V",)
    with pytest.raises(UsageError, match="said to close at 0 V, and by machine file and wiring at 5 V"):
        with_closed(("closed=5V",), 0.0, 0.0)
