"""A layout learnt from one message decodes the others, and recognises those that differ."""

import numpy as np
import pytest
from records.making import STORE, random_message, serialized

from pneumo_ros.records.layout import Layout, leaves

JOINTS = "sensor_msgs/msg/JointState"
BULK = [kind for kind in STORE.fielddefs if all(leaf.base != "message" for leaf in leaves(STORE, kind))]


def joint_state(name: list[str], position: list[float], frame: str = "") -> bytes:
    """JointState with a stamp that shows in every byte."""
    stamp = STORE.types["builtin_interfaces/msg/Time"](sec=0x01020304, nanosec=0x05060708)
    header = STORE.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame)
    values = np.array(position)
    return serialized(
        STORE.types[JOINTS](header=header, name=name, position=values, velocity=values[:0], effort=values)
    )


def rows(*payloads: bytes) -> np.ndarray:
    """Messages of one length as void items."""
    return np.frombuffer(b"".join(payloads), dtype=f"V{len(payloads[0])}")


def test_columns_of_a_joint_state() -> None:
    payload = joint_state(["piston"], [1.5])
    layout = Layout(payload, leaves(STORE, JOINTS))
    values = rows(payload, joint_state(["piston"], [-2.5])).view(layout.dtype)
    assert values["position"].tolist() == [[1.5], [-2.5]]
    assert values["effort"].tolist() == [[1.5], [-2.5]]
    assert values["velocity"].shape == (2, 0)
    assert values["header.stamp.sec"].tolist() == [0x01020304] * 2
    assert layout.texts == {"header.frame_id": "", "name": ("piston",)}


@pytest.mark.parametrize(
    "other",
    [joint_state(["pistol"], [1.5]), joint_state(["piston"], [1.5], "f\0\0\0"), joint_state(["pisto\0"], [1.5])],
)
def test_messages_that_differ_in_more_than_numbers_do_not_match(other: bytes) -> None:
    payload = joint_state(["piston"], [1.5])
    layout = Layout(payload, leaves(STORE, JOINTS))
    size = max(len(payload), len(other))
    if len(other) == len(payload):
        assert layout.matches(rows(payload, other, payload)).tolist() == [True, False, True]
    else:  # another length is recognised before
        assert layout.length != size


def test_padding_does_not_matter() -> None:
    payload = joint_state(["piston"], [1.5])
    layout = Layout(payload, leaves(STORE, JOINTS))
    at = payload.index(b"\0\0\0\0\1\0\0\0\7")  # the empty frame: its zero, then three bytes of padding
    dirty = payload[: at + 1] + b"\xaa\xbb\xcc" + payload[at + 4 :]
    assert layout.matches(rows(payload, dirty)).tolist() == [True, True]


@pytest.mark.parametrize("kind", ["builtin_interfaces/msg/Time", JOINTS, "sensor_msgs/msg/Imu", "std_msgs/msg/String"])
@pytest.mark.parametrize("little_endian", [True, False])
def test_every_byte_of_a_bulk_message_is_accounted_for(kind: str, little_endian: bool) -> None:
    for seed in range(20):
        payload = serialized(random_message(kind, np.random.default_rng(seed)), little_endian)
        layout = Layout(payload, leaves(STORE, kind))
        assert Layout(payload + b"stray", leaves(STORE, kind)).texts == layout.texts
        for broken in (payload[:-4], b"\0\3" + payload[2:], payload[:4]):
            with pytest.raises(ValueError, match=r"bytes|CDR|string"):
                Layout(broken, leaves(STORE, kind))


def test_most_types_are_decoded_in_bulk() -> None:
    assert {JOINTS, "sensor_msgs/msg/FluidPressure", "std_msgs/msg/Float64", "std_msgs/msg/String"} <= set(BULK)
    assert "tf2_msgs/msg/TFMessage" not in BULK


def test_a_damaged_count_makes_no_long_loop() -> None:
    payload = bytearray(joint_state(["piston"], [1.5]))
    at = payload.index(b"\1\0\0\0\7\0\0\0piston")
    payload[at : at + 4] = b"\xff\xff\xff\xff"
    with pytest.raises(ValueError, match="too few"):
        Layout(bytes(payload), leaves(STORE, JOINTS))
