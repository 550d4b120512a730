"""Definitions from Python's message classes equal those of rosbags for the same types."""

from importlib import import_module

import pytest

from pneumo_ros.errors import UsageError
from pneumo_ros.records.message_types import definition_of, same_fields, standard_types, types_of
from pneumo_ros.ros.message_classes import definition, message_class

PACKAGES = (
    "std_msgs",
    "sensor_msgs",
    "geometry_msgs",
    "trajectory_msgs",
    "diagnostic_msgs",
    "rcl_interfaces",
    "rosgraph_msgs",
)
TYPES = [
    kind
    for kind in standard_types().fielddefs
    if kind.split("/")[0] in PACKAGES and hasattr(import_module(f"{kind.split('/')[0]}.msg"), kind.split("/")[2])
]
# Python's classes say uint8 for char, which is another type to the hash
WITH_CHAR = {kind for kind in TYPES if "'char'" in str(standard_types().fielddefs[kind][1])}


def test_there_are_types_to_compare() -> None:
    assert len(TYPES) > 80
    assert len(WITH_CHAR) < 5


@pytest.mark.parametrize("kind", TYPES)
def test_definitions_agree(kind: str) -> None:
    told = types_of(kind, "ros2msg", definition(kind))
    assert same_fields(told, standard_types(), kind)
    if kind not in WITH_CHAR:
        assert told.hash_rihs01(kind) == standard_types().hash_rihs01(kind)
    assert definition_of(kind, definition(kind)) == definition_of(kind)


def test_types_of_ones_own_are_described_by_their_class(monkeypatch: pytest.MonkeyPatch) -> None:
    """An installed type that is unknown to rosbags, or has other fields there."""
    package = import_module("sensor_msgs.msg")
    fields = {
        "header": "std_msgs/Header", "few": "sequence<double, 3>", "grid": "float[4]", "name": "string<10>",
        "on": "boolean", "raw": "sequence<octet>", "joints": "sequence<sensor_msgs/JointState>",
    }  # fmt: skip
    own = type("Own", (), {"get_fields_and_field_types": classmethod(lambda cls: fields)})
    monkeypatch.setattr(package, "Own", own, raising=False)
    text, type_hash = definition_of("sensor_msgs/msg/Own", definition("sensor_msgs/msg/Own"))
    assert text.splitlines()[:7] == [
        "std_msgs/Header header", "float64[<=3] few", "float32[4] grid", "string<=10 name", "bool on", "byte[] raw",
        "sensor_msgs/JointState[] joints",
    ]  # fmt: skip
    assert "MSG: sensor_msgs/JointState" in text
    assert "MSG: builtin_interfaces/Time" in text
    assert type_hash == types_of("sensor_msgs/msg/Own", "ros2msg", text).hash_rihs01("sensor_msgs/msg/Own")
    monkeypatch.setattr(package, "Imu", own)
    assert definition_of("sensor_msgs/msg/Imu", definition("sensor_msgs/msg/Imu"))[0] == text


@pytest.mark.parametrize("kind", ["no_msgs/msg/None", "std_msgs/msg/Nothing", "std_msgs", ""])
def test_types_that_are_not_installed(kind: str) -> None:
    with pytest.raises(UsageError, match="is not installed"):
        message_class(kind)
