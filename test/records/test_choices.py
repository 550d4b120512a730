"""Several axes, joints or recordings in one place: a clear choice is made, otherwise the user is asked."""

from pathlib import Path

import numpy as np
import pytest
from records.axis_bag import SIGNALS, STAMP, N, streams, write
from records.making import START, STORE, serialized, write_rosbags

from pneumo_ros.errors import DataError
from pneumo_ros.records import BagWriter, encoding, read_recording, read_topics
from pneumo_ros.records.contract import COMMAND, JOINT_STATES, PRESSURE_A, PRESSURE_B, TYPES


def joint_states(names: list[list[str]], position: np.ndarray) -> list[bytes]:
    """JointState messages: names of each, and positions (n, joints)."""
    header = STORE.types["std_msgs/msg/Header"]
    time = STORE.types["builtin_interfaces/msg/Time"]
    return [
        serialized(
            STORE.types[TYPES[JOINT_STATES]](
                header=header(stamp=time(*divmod(int(stamp), 10**9)), frame_id=""),
                name=names[index % len(names)],
                position=position[index, : max(1, len(names[index % len(names)]))],
                velocity=np.empty(0),
                effort=np.empty(0),
            )
        )
        for index, stamp in enumerate(STAMP)
    ]


def two_axes(path: Path) -> Path:
    """A bag with the same axis under two namespaces."""
    left, right = streams(), streams()
    merged = {f"left/{name}": series for name, series in left.items()} | {
        f"right/{name}": series for name, series in right.items()
    }
    return write(path, merged, types={name: TYPES[name.split("/", 1)[1]] for name in merged})


def test_several_axes_must_be_distinguished(tmp_path: Path) -> None:
    path = two_axes(tmp_path / "run")
    with pytest.raises(DataError, match=r"2 axes: /left, /right. Say which: --namespace /left"):
        read_recording(path)
    assert read_recording(path, "/right").namespace == "right"
    assert read_recording(path, "left").namespace == "left"
    with pytest.raises(DataError, match="did you mean /right"):
        read_recording(path, "/righ")


def test_joint_states_of_a_robot_beside_those_of_the_axis(tmp_path: Path) -> None:
    content = {f"cell/axis/{name}": series for name, series in streams().items()}
    content["joint_states"] = content[f"cell/axis/{JOINT_STATES}"]
    types = {name: TYPES[name.removeprefix("cell/axis/")] for name in content}
    assert read_recording(write(tmp_path / "run", content, types=types)).namespace == "cell/axis"


@pytest.mark.parametrize("names", [[["arm", "piston", "hand"]], [["piston", "arm"], ["arm", "piston"]]])
def test_the_piston_among_other_joints(tmp_path: Path, names: list[list[str]]) -> None:
    position = np.random.default_rng(0).normal(size=(N, 3))
    content = streams()
    content[JOINT_STATES] = (STAMP, joint_states(names, position))
    recording = read_recording(write(tmp_path / "run", content))
    expected = [position[index, names[index % len(names)].index("piston")] for index in range(N)]
    assert recording.joint_name == "piston"
    np.testing.assert_array_equal(recording.position, expected)


def test_joints_must_be_distinguished(tmp_path: Path) -> None:
    position = np.random.default_rng(0).normal(size=(N, 2))
    content = streams()
    content[JOINT_STATES] = (STAMP, joint_states([["arm", "rod"]], position))
    path = write(tmp_path / "run", content)
    with pytest.raises(DataError, match=r"several joints \(arm, rod\).*--joint"):
        read_recording(path)
    np.testing.assert_array_equal(read_recording(path, joint_name="rod").position, position[:, 1])
    with pytest.raises(DataError, match="did you mean rod"):
        read_recording(path, joint_name="rot")


def test_messages_of_other_joints_are_passed_over(tmp_path: Path) -> None:
    position = np.random.default_rng(0).normal(size=(N, 1))
    content = streams()
    content[JOINT_STATES] = (STAMP, joint_states([["piston"], ["arm"]], position))
    np.testing.assert_array_equal(read_recording(write(tmp_path / "run", content)).position, position[::2, 0])


def test_a_joint_without_a_name(tmp_path: Path) -> None:
    position = np.random.default_rng(0).normal(size=(N, 1))
    content = streams()
    content[JOINT_STATES] = (STAMP, joint_states([[]], position))
    recording = read_recording(write(tmp_path / "run", content))
    assert recording.joint_name == "piston"
    np.testing.assert_array_equal(recording.position, position[:, 0])


def test_velocity_in_some_messages_only(tmp_path: Path) -> None:
    content = streams()
    fields = {"position": SIGNALS["position"], "effort": None}
    rows = encoding.joint_states(STAMP, "piston", {**fields, "velocity": None})
    rows[::2] = encoding.joint_states(STAMP, "piston", {**fields, "velocity": SIGNALS["velocity"]})[::2]
    content[JOINT_STATES] = (STAMP, rows)
    recording = read_recording(write(tmp_path / "run", content))
    assert recording.velocity is None
    np.testing.assert_array_equal(recording.position, SIGNALS["position"])
    assert any("200 of 400 values of velocity" in warning for warning in recording.warnings)


def test_a_path_that_is_not_there(tmp_path: Path) -> None:
    BagWriter(tmp_path / "holdout").close()
    with pytest.raises(DataError, match="did you mean holdout"):
        read_recording(tmp_path / "holdot")
    with pytest.raises(DataError, match="does not exist"):
        read_recording(tmp_path / "a" / "b")


def test_a_folder_of_recordings(tmp_path: Path) -> None:
    for name in ("a", "b"):
        BagWriter(tmp_path / name).close()
    with pytest.raises(DataError, match=rf"holds 2. Name one of them: {tmp_path}/a, {tmp_path}/b"):
        read_recording(tmp_path)
    (tmp_path / "empty").mkdir()
    with pytest.raises(DataError, match="holds no recording"):
        read_recording(tmp_path / "empty")


def test_a_folder_of_files_that_do_not_belong_together(tmp_path: Path) -> None:
    for name in ("a", "b"):
        with BagWriter(tmp_path / name) as writer:
            pass
        (writer.path / f"{name}_0.mcap").rename(tmp_path / f"{name}.mcap")
    with pytest.raises(DataError, match=r"several recordings: a.mcap, b.mcap. Name one"):
        read_topics(tmp_path)


def test_a_recording_without_messages(tmp_path: Path) -> None:
    BagWriter(tmp_path / "run").close()
    with pytest.raises(DataError, match="holds no messages"):
        read_recording(tmp_path / "run")


def test_names_of_recordings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path / "run.1", streams())
    monkeypatch.chdir(path)
    for given, name in (
        (path, "run.1"),
        (path / "metadata.yaml", "run.1"),
        (path / "run.1_0.mcap", "run.1_0"),
        (".", "run.1"),
    ):
        assert read_recording(given).name == name


def test_a_definition_nobody_knows(tmp_path: Path) -> None:
    messages = [("/x", "std_msgs/msg/Float64", START, serialized(STORE.types["std_msgs/msg/Float64"](data=1.0)))]
    path = write_rosbags(tmp_path / "run", messages)
    file = next(path.glob("*.mcap"))
    file.write_bytes(
        file.read_bytes()
        .replace(b"std_msgs/msg/Float64", b"yyy_msgs/msg/Float64")
        .replace(b"float64 data", b"float46 data")
    )
    with pytest.raises(DataError, match="yyy_msgs/msg/float46"):
        read_topics(path)


def test_one_pressure_is_enough_and_none_is_not(tmp_path: Path) -> None:
    content = streams()
    del content[PRESSURE_A], content[COMMAND]
    assert read_recording(write(tmp_path / "one", content)).pressures_drive
    del content[PRESSURE_B]
    with pytest.raises(DataError, match="lacks valve/command or the effort"):
        read_recording(write(tmp_path / "run", content))
