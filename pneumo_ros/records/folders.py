"""The recordings in a folder."""

from pathlib import Path

_FILES = (".mcap", ".db3")


def recordings_in(folder: Path) -> list[Path]:
    """The recordings in `folder`, by name; none if it is itself a recording, or no folder."""
    if not folder.is_dir() or (folder / "metadata.yaml").exists():
        return []
    entries = sorted(folder.iterdir())
    folders = [entry for entry in entries if entry.is_dir() and _holds_files(entry)]
    if not folders:  # one recording whose recorder was killed, or nothing; reading it shows which
        return []
    return sorted([*folders, *(entry for entry in entries if entry.suffix in _FILES)])


def _holds_files(folder: Path) -> bool:
    return (folder / "metadata.yaml").exists() or any(entry.suffix in _FILES for entry in folder.iterdir())
