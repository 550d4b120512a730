"""Channels and schemas of an MCAP file, and whether its recorder could close it."""

import struct
from functools import lru_cache
from io import BytesIO

from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode

from pneumo_ros.errors import UsageError
from pneumo_ros.records.block import Channel
from pneumo_ros.yaml_text import load_yaml

LIBRARY = "pneumo_ros"  # name of the writer in files written here


class Registry:
    """Collects the records that `take` receives."""

    def __init__(self) -> None:
        self.channels: dict[int, Channel] = {}
        self.unfinished = False  # written here by a recorder that was killed: valid, but without summary
        self.unreadable = 0  # records
        self._schemas: dict[int, records.Schema] = {}
        self._library = ""

    def take(self, opcode: int, body: bytes) -> None:
        """Evaluate a record; kinds that do not concern messages are skipped."""
        stream = ReadDataStream(BytesIO(body))
        try:
            if opcode == Opcode.SCHEMA:
                schema = records.Schema.read(stream)
                self._schemas[schema.id] = schema
            elif opcode == Opcode.CHANNEL:
                channel = records.Channel.read(stream)
                self.channels[channel.id] = self._describe(channel)
            elif opcode == Opcode.HEADER:
                self._library = records.Header.read(stream).library
            elif opcode == Opcode.FOOTER:
                no_summary = records.Footer.read(stream).summary_start == 0
                self.unfinished = no_summary and self._library.startswith(LIBRARY)
        except (McapError, struct.error, UnicodeDecodeError):
            self.unreadable += 1

    def _describe(self, channel: records.Channel) -> Channel:
        """The channel with the text of its schema."""
        schema = self._schemas.get(channel.schema_id, records.Schema(0, b"", "", ""))
        return Channel(
            channel.topic,
            schema.name,
            channel.message_encoding,
            schema.encoding,
            schema.data.decode(errors="replace"),
            _latches(channel.metadata.get("offered_qos_profiles", "")),
        )


@lru_cache(maxsize=256)  # every chunk repeats its channels
def _latches(profiles: str) -> bool:
    """Whether one of the YAML quality-of-service `profiles` is transient local (rosbag2 writes the name or a 1)."""
    try:
        offered = load_yaml(profiles)
    except UsageError:
        return False
    return isinstance(offered, list) and any(
        isinstance(one, dict) and one.get("durability") in (1, "transient_local") for one in offered
    )
