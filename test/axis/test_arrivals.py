"""Which bags count as complete: closed ones, and those that no longer grow."""

import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.axis.identification.arrivals import DEAD, Arrivals, closed, found
from pneumo_ros.records import BagTopic, BagWriter, write_recording

COMMAND = BagTopic("/valve/command", "std_msgs/msg/Float64")
PAYLOAD = b"\x00\x01\x00\x00" + bytes(8)


def bag(path: Path) -> Path:
    """A small recording, closed."""
    time = 0.01 * np.arange(100)
    still = np.zeros(100)
    write_recording(path, time=time, position=still, pressure_a=still + 2e5, pressure_b=still + 2e5, voltage=still)
    return path


class Watch:
    """Looks at a folder at times of the test's choice."""

    def __init__(self, folder: Path) -> None:
        self.time = 0.0
        self.folder = folder
        self._arrivals = Arrivals(lambda: self.time)

    def after(self, seconds: float, *named: Path) -> tuple[set[str], dict[str, str]]:
        """Names of complete recordings, and of others with the reason, `seconds` after the last look."""
        self.time += seconds
        ready, waiting = self._arrivals.look(named, self.folder)
        return {path.name for path in ready}, {path.name: why for path, why in waiting.items()}


def test_a_closed_bag_is_complete_at_the_second_look(tmp_path: Path) -> None:
    bag(tmp_path / "run")
    watch = Watch(tmp_path)
    assert watch.after(0.0) == (set(), {"run": "is still being written"})
    assert watch.after(0.5) == ({"run"}, {})


def test_an_open_bag_waits_until_it_is_closed(tmp_path: Path) -> None:
    watch = Watch(tmp_path)
    writer = BagWriter(tmp_path / "run", [COMMAND])
    for k in range(5):
        writer.write("/valve/command", k, PAYLOAD)
        writer.flush()
        assert watch.after(0.9 * DEAD) == (set(), {"run": "is still being written"})
    writer.close()
    watch.after(0.5)
    assert watch.after(0.5) == ({"run"}, {})


def test_a_bag_whose_writer_was_killed_is_complete_after_a_while(tmp_path: Path) -> None:
    writer = BagWriter(tmp_path / "run", [COMMAND])
    writer.write("/valve/command", 1, PAYLOAD)
    writer.flush()
    watch = Watch(tmp_path)
    watch.after(0.0)
    assert watch.after(0.9 * DEAD)[0] == set()
    assert watch.after(0.2 * DEAD)[0] == {"run"}
    writer.close()


def test_a_bag_without_metadata_waits_as_if_it_were_open(tmp_path: Path) -> None:
    bag(tmp_path / "run")
    (tmp_path / "run" / "metadata.yaml").unlink()
    watch = Watch(tmp_path)
    watch.after(0.0)
    assert watch.after(1.0)[0] == set()
    assert watch.after(DEAD)[0] == {"run"}


def test_files_folders_and_folders_of_folders_are_found(tmp_path: Path) -> None:
    bag(tmp_path / "b_run")
    shutil.copy(tmp_path / "b_run" / "b_run_0.mcap", tmp_path / "a_file.mcap")
    bag(tmp_path / "deeper" / "run" if (tmp_path / "deeper").mkdir() is None else tmp_path)
    (tmp_path / ".hidden").mkdir()
    shutil.copy(tmp_path / "a_file.mcap", tmp_path / ".hidden" / "x.mcap")
    (tmp_path / "notes.txt").write_text("no recording", encoding="utf-8")
    assert [path.relative_to(tmp_path).as_posix() for path in found(tmp_path)] == [
        "a_file.mcap", "b_run", "deeper/run",
    ]  # fmt: skip
    watch = Watch(tmp_path)
    watch.after(0.0)
    assert watch.after(0.5)[0] == {"a_file.mcap", "b_run", "run"}


def test_named_ones_are_waited_for_and_counted_once(tmp_path: Path) -> None:
    watch = Watch(tmp_path)
    later = tmp_path / "later"
    assert watch.after(0.0, later) == (set(), {"later": "does not exist yet"})
    later.mkdir()
    assert watch.after(0.5, later) == (set(), {"later": "holds no recording yet"})
    later.rmdir()
    bag(later)
    watch.after(0.5, later)
    assert watch.after(0.5, later) == ({"later"}, {})


def test_a_changed_bag_gets_another_mark(tmp_path: Path) -> None:
    path = bag(tmp_path / "run")
    arrivals = Arrivals(lambda: 0.0)
    arrivals.look([path], None)
    before = arrivals.look([path], None)[0][path]
    assert arrivals.look([path], None)[0][path] == before
    os.utime(path / "run_0.mcap", (1, 1))
    assert arrivals.look([path], None)[0] == {}
    assert arrivals.look([path], None)[0][path] != before


@pytest.mark.parametrize("content", [b"", b"garbage", b"\x89MCAP0\r\n", b"\x89MCAP0\r\n" + bytes(60)])
def test_what_is_not_an_mcap_file_is_not_closed(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "broken.mcap"
    path.write_bytes(content)
    assert not closed(path)


def test_a_database_with_a_journal_is_being_written(tmp_path: Path) -> None:
    database = tmp_path / "run.db3"
    database.write_bytes(b"x")
    assert closed(database)
    (tmp_path / "run.db3-wal").write_bytes(b"x")
    assert not closed(database)
