"""A table on its way to a recording: its columns, the map that `pneumo import --guess` wrote, and its edits."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from pneumo_ros.tables.map_file import parse_map
from pneumo_ros.yaml_text import load_yaml


@dataclass(frozen=True)
class Mapped:
    """A table at `table` with its map at `map`, both relative to the desk's folder; `guess` is the JSON of the verb."""

    table: str
    map: str
    guess: Mapping[str, Any]
    content: Mapping[str, Any]  # of the map

    @property
    def columns(self) -> list[str]:
        """Every column of the table."""
        time = [self.guess["time"]["column"]] if self.guess["time"] else []
        used = [one["column"] for one in self.guess["signals"].values()]
        return list(dict.fromkeys([*time, *used, *self.guess["unused"]]))


def mapped(folder: Path, table: str, map_file: str, result: str) -> Mapped:
    """What the guess of a table wrote into `folder`."""
    found = json.loads((folder / result).read_text(encoding="utf-8"))
    content = load_yaml((folder / map_file).read_text(encoding="utf-8"))
    return Mapped(table, map_file, found["guess"], content)


def edited(
    one: Mapped, timing: Mapping[str, Any], rows: Mapping[str, Mapping[str, Any]], motion: str
) -> dict[str, Any]:
    """The content of a map with what a person chose. Raises UsageError as `parse_map` does.

    rows: signal -> column (None leaves it out), unit, sign, offset, gauge; other keys of the guess are kept.
    """
    before, signals = one.content.get("signals") or {}, dict[str, Any]()
    for signal, row in rows.items():
        if row["column"]:
            kept = before.get(signal, {}) if before.get(signal, {}).get("column") == row["column"] else {}
            own = {key: value for key, value in row.items() if value not in (None, "")}
            signals[signal] = {key: value for key, value in kept.items() if key not in row} | own
    content = dict(one.content) | {"time": dict(timing), "motion": motion, "signals": signals}
    parse_map(content)
    return content


def free_name(stem: str, folder: Path) -> str:
    """A name for a new recording in `folder`, with a number where `stem` is taken."""
    taken = {path.name for path in folder.iterdir()}
    names = (stem, *(f"{stem}_{k}" for k in range(2, len(taken) + 3)))
    return next(name for name in names if name not in taken)


def map_text(content: Mapping[str, Any]) -> str:
    """A map as a YAML file."""
    return str(yaml.safe_dump(dict(content), sort_keys=False, allow_unicode=True))
