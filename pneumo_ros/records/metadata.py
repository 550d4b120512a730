"""metadata.yaml of a rosbag2 folder, version 9, as ROS 2 Jazzy and later write it."""

import os
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from pneumo_ros.records.source import METADATA, ROOT

VERSION = 9
_FOREVER = {"sec": 9223372036, "nsec": 854775807}
_NEVER = 2**63 - 1  # start of a recording without messages


class BagTopic(NamedTuple):
    """A topic to be recorded, and how its publisher offered it."""

    name: str
    type: str
    latched: bool = False  # transient local
    reliable: bool = True
    definition: str = ""  # of the type, as in a .msg file; "" for the standard type

    def profiles(self) -> list[dict[str, Any]]:
        """The offered quality of service in rosbag2's words; `ros2 bag play` publishes with it."""
        return [
            {
                "history": "keep_last",
                "depth": 1 if self.latched else 10,
                "reliability": "reliable" if self.reliable else "best_effort",
                "durability": "transient_local" if self.latched else "volatile",
                "deadline": dict(_FOREVER),
                "lifespan": dict(_FOREVER),
                "liveliness": "automatic",
                "liveliness_lease_duration": dict(_FOREVER),
                "avoid_ros_namespace_conventions": False,
            }
        ]


class Contents(NamedTuple):
    """Contents of a folder at one moment; times in ns, None without messages."""

    file: str
    topics: list[tuple[BagTopic, str, int]]  # topic, RIHS01 hash of its type, messages
    start: int | None
    end: int | None


def information(contents: Contents) -> dict[str, Any]:
    """The content of metadata.yaml."""
    count = sum(messages for _, _, messages in contents.topics)
    start = _NEVER if contents.start is None else contents.start
    span = {
        "starting_time": {"nanoseconds_since_epoch": start},
        "duration": {"nanoseconds": 0 if contents.end is None else contents.end - start},
        "message_count": count,
    }
    return {
        "version": VERSION,
        "storage_identifier": "mcap",
        "relative_file_paths": [contents.file],
        **span,
        "topics_with_message_count": [_topic(*one) for one in contents.topics],
        "compression_format": "",
        "compression_mode": "",
        "files": [{"path": contents.file, **span}],
        "custom_data": None,
        "ros_distro": "rosbags",  # whose type definitions the file carries
    }


def _topic(topic: BagTopic, type_hash: str, messages: int) -> dict[str, Any]:
    return {
        "topic_metadata": {
            "name": topic.name,
            "type": topic.type,
            "serialization_format": "cdr",
            "offered_qos_profiles": topic.profiles(),
            "type_description_hash": type_hash,
        },
        "message_count": messages,
    }


def write_metadata(folder: Path, content: dict[str, Any]) -> None:
    """Put metadata.yaml into `folder`, whole or not at all. Raises OSError."""
    unfinished = folder / f".{METADATA}.part"
    unfinished.write_text(as_yaml({ROOT: content}), encoding="utf-8")
    os.replace(unfinished, folder / METADATA)


def as_yaml(content: Any) -> str:
    """YAML text that rosbag2 and rosbags read: every value in full, no references."""
    return yaml.dump(content, Dumper=_Dumper, sort_keys=False)


class _Dumper(yaml.SafeDumper):
    def ignore_aliases(self, data: Any) -> bool:
        return True
