"""A recording cut at random places: the messages read from the rest against those of the whole before the cut.

The oracle is the `mcap` library, which walks the records of the whole file once and says where each chunk ends.
"""

import os
import struct
from contextlib import suppress
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import NamedTuple

from mcap.exceptions import McapError
from mcap.records import Chunk, Message
from mcap.stream_reader import StreamReader, breakup_chunk

from fuzz import recordings
from pneumo_ros.errors import DataError
from pneumo_ros.records import Bag

Found = list[tuple[int, bytes]]  # recorded time [ns] and payload, in the order of the file


class Cuts(NamedTuple):
    """The results of the cuts: messages before them in whole chunks, messages read, and the places of errors."""

    name: str
    places: int
    before: int
    read: int
    wrong: list[str]

    def text(self) -> str:
        """A few lines."""
        words = "\n".join(self.wrong[:5]) or "every message of a whole chunk before the cut was read, none was made up"
        return (
            f"{self.name} cut at {self.places} random places: {self.before} messages in whole chunks before the cuts, "
            f"{self.read} read (part of a cut chunk is read as well), {len(self.wrong)} cuts wrong\n{words}"
        )


def recording() -> tuple[str, bytes]:
    """A recording of the rig where there is one, else an artificial one."""
    rig = os.environ.get("PNEUMO_RIG", "")
    found = sorted(Path(rig, "healthy").glob("constant_p1500/*.mcap")) if rig else []
    return (
        (f"rig recording {found[0].stem}", found[0].read_bytes())
        if found
        else ("recording", recordings.mcap_seeds()[2])
    )


def ends(data: bytes) -> list[tuple[int, int]]:
    """Where each chunk ends in the file, and how many messages it and those before it hold."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "whole.mcap"
        path.write_bytes(data)
        found, count = [], 0
        # the given file may itself end within a record: the library raises one of these two errors
        with path.open("rb") as stream, suppress(struct.error, McapError):
            for record in StreamReader(stream, emit_chunks=True).records:
                if isinstance(record, Chunk):
                    count += sum(isinstance(inner, Message) for inner in breakup_chunk(record))
                    found.append((stream.tell(), count))
    return found


def read(path: Path) -> Found:
    """Messages in the order of the file; none when there is no recording."""
    try:
        blocks = list(Bag(path).blocks())
    except DataError:
        return []
    return [(int(block.log_time[i]), block.payload(i)) for block in blocks for i in range(len(block.channel))]


def campaign(count: int, seed: int, name_and_data: tuple[str, bytes] | None = None) -> Cuts:
    """Cut a recording at `count` places that `seed` draws."""
    name, data = name_and_data or recording()
    chunks, random, wrong, before, total = ends(data), Random(seed), [], 0, 0
    with TemporaryDirectory() as folder:
        path = Path(folder) / "cut.mcap"
        path.write_bytes(data)
        whole = read(path)
        for place in (random.randrange(len(data)) for _ in range(count)):
            path.write_bytes(data[:place])
            found, least = read(path), max((held for end, held in chunks if end <= place), default=0)
            before, total = before + least, total + len(found)
            if found != whole[: len(found)] or len(found) < least:
                wrong.append(f"cut at {place}: {len(found)} messages read, {least} lie before it")
    return Cuts(name, count, before, total, wrong)
