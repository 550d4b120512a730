"""The files of a recording: a rosbag2 folder, a folder whose recorder was killed, or one file."""

import re
from collections.abc import Iterator
from pathlib import Path, PurePath
from typing import Any, Protocol

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.block import Block
from pneumo_ros.records.foreign import ForeignBag
from pneumo_ros.records.mcap_file import McapFile
from pneumo_ros.yaml_text import load_yaml

METADATA = "metadata.yaml"
ROOT = "rosbag2_bagfile_information"


class Source(Protocol):
    """One file or folder that yields blocks, and warnings about unreadable parts."""

    warnings: list[str]

    def blocks(self) -> Iterator[Block]:
        """Messages, a block at a time."""
        ...


def find_sources(path: Path) -> tuple[list[Source], list[str]]:
    """Sources of the recording at `path` in the order of recording, and warnings about the folder.

    Raises DataError when there is nothing to read, or more than one recording.
    """
    if path.name == METADATA:
        path = path.parent
    if not path.exists():
        raise DataError(_absent(path))
    if path.is_file():
        return [_single(path)], []
    information, warnings = _information(path)
    if information is None:
        return _without_metadata(path), warnings
    if information.get("storage_identifier") != "mcap" or information.get("compression_mode"):
        return [ForeignBag(path)], warnings
    listed = [path / PurePath(name).name for name in information["relative_file_paths"]]
    there = [file for file in listed if file.exists()]
    if not there:
        raise DataError(f"{path / METADATA} lists {_names(listed)}, but the folder holds none of them.")
    if lost := [file for file in listed if file not in there]:
        warnings.append(f"{path.name} lacks {_names(lost)}, which its {METADATA} lists; the rest is read.")
    return [McapFile(file) for file in there], warnings


def recording_name(path: Path) -> str:
    """Name of the recording at `path`: of its folder, or of its file without the ending."""
    folder = path.parent if path.name == METADATA else path
    return folder.resolve().name if folder.is_dir() else path.stem


def _information(path: Path) -> tuple[dict[str, Any] | None, list[str]]:
    """Content of the folder's metadata.yaml; None with a warning when it is missing or broken."""
    try:
        content = load_yaml((path / METADATA).read_text(encoding="utf-8"))
        information: dict[str, Any] = content[ROOT]
        listed = information["relative_file_paths"]
        if isinstance(listed, list) and listed and all(isinstance(name, str) for name in listed):
            return information, []
    except FileNotFoundError:
        return None, [f"{path.name} has no {METADATA}: its recorder was killed. Its files are read as they are."]
    except (OSError, UnicodeDecodeError, UsageError, KeyError, TypeError):
        pass
    return None, [f"The {METADATA} of {path.name} is damaged. The files of the folder are read as they are."]


def _without_metadata(path: Path) -> list[Source]:
    """The files of a folder, in the order of the numbers at the end of their names."""
    files = sorted((file for file in path.iterdir() if file.suffix in (".mcap", ".db3")), key=_part)
    if not files:
        raise DataError(_no_recording(path))
    if len({_part(file)[0] for file in files}) > 1:
        raise DataError(f"{path} holds several recordings: {_names(files)}. Name one of them: {files[0]}")
    return [_single(file) for file in files]


def _single(path: Path) -> Source:
    """Reader for one file, by its ending."""
    if path.suffix == ".db3":
        return ForeignBag(path)
    if path.suffix in (".zstd", ".zst", ".lz4", ".gz"):
        raise DataError(f"{path} is a compressed file; name the folder it belongs to ({path.parent}) or unpack it.")
    return McapFile(path)


def _part(path: Path) -> tuple[str, int]:
    """Name and number of one part of a split recording: `run_10.mcap` is ("run", 10)."""
    found = re.fullmatch(r"(.+)_(\d+)", path.stem)
    return (found[1], int(found[2])) if found else (path.stem, -1)


def _absent(path: Path) -> str:
    """Sentence for a path that does not exist, with the names nearest to it."""
    if not path.parent.is_dir():
        return f"There is no {path}: the folder {path.parent} does not exist."
    neighbours = [entry.name for entry in path.parent.iterdir() if _looks_recorded(entry)]
    return f"There is no {path}: {unknown_name('recording', path.name, neighbours)}"


def _no_recording(path: Path) -> str:
    """Sentence for a folder without storage files; it may hold folders that have them."""
    inside = sorted(str(entry) for entry in path.iterdir() if _looks_recorded(entry))
    if inside:
        more = f" and {len(inside) - 8} more" if len(inside) > 8 else ""
        return f"{path} is no recording but holds {len(inside)}. Name one of them: {', '.join(inside[:8])}{more}"
    return f"{path} holds no recording: neither a {METADATA} nor a .mcap or .db3 file."


def _looks_recorded(path: Path) -> bool:
    """Whether `path` looks like a recording."""
    if path.is_dir():
        return any(entry.suffix in (".mcap", ".db3") or entry.name == METADATA for entry in path.iterdir())
    return path.suffix in (".mcap", ".db3")


def _names(paths: list[Path]) -> str:
    """File names with commas between them."""
    return ", ".join(path.name for path in paths)
