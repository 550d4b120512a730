"""The parts that there are: those of the package, of the folders in PNEUMO_PARTS, and of folders named on the way."""

import os
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from pathlib import Path

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.parts.figure import Figure
from pneumo_ros.parts.part import Part, figure_of, part_of, source_text
from pneumo_ros.parts.quantity import LONGEST, parse
from pneumo_ros.yaml_text import load_yaml

VARIABLE = "PNEUMO_PARTS"  # folders, separated as in PATH
_MOST = 10_000  # part files in a folder: more are no folder of parts
_OWN = "a part of your own: --parts FOLDER, see docs/parts.md"


@dataclass(frozen=True)
class Shelf:
    """Parts by name."""

    parts: dict[str, Part]

    def find(self, name: str, *kinds: str) -> Part:
        """The part of that name, of one of the `kinds` if any are given; UsageError with the nearest names."""
        if name not in self.parts:
            named = [one.name for one in self.parts.values() if not kinds or one.kind in kinds]
            raise UsageError(f"{unknown_name(' or '.join(kinds) or 'part', name[:LONGEST], named)} ({_OWN})")
        part = self.parts[name]
        if kinds and part.kind not in kinds:
            raise UsageError(f"{name} is a {part.kind}; this takes a {' or '.join(kinds)} (see: pneumo parts)")
        return part

    def cylinder(self, name: str) -> tuple[Part, float | None]:
        """A cylinder, and its stroke [m] where the name ends with it in mm: iso15552-32-250; UsageError as `find`."""
        base, dash, stroke = name.rpartition("-")
        if name in self.parts or not dash or base not in self.parts:
            return self.find(name, "cylinder"), None
        return self.find(base, "cylinder"), parse(stroke, "length", f"the stroke of {name}", plain="mm", example="250")


def load_shelf(folders: Iterable[str | Path] = ()) -> Shelf:
    """Shipped parts, then those of $PNEUMO_PARTS and `folders`.

    UsageError for a folder that is missing or holds no part, a file that describes none, or a name that is taken.
    """
    parts = dict(_shipped())
    named = [path for path in os.environ.get(VARIABLE, "").split(os.pathsep) if path]
    for folder in (*named, *folders):
        for part in _of_folder(Path(folder), VARIABLE if folder in named else "--parts"):
            if part.name in parts:
                raise UsageError(
                    f"{part.file}: the name {part.name} is taken by {parts[part.name].file}; choose another"
                )
            parts[part.name] = part
    return Shelf(parts)


def read_part(path: Path) -> Part:
    """The part of a file; UsageError for what describes no part, DataError for what cannot be read."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(
            f"part file {path} cannot be read ({getattr(error, 'strerror', None) or 'no UTF-8'})"
        ) from error
    try:
        return part_of(load_yaml(text), str(path))
    except UsageError as error:
        raise UsageError(str(error) if str(path) in str(error) else f"part file {path}: {error}") from error


@lru_cache(maxsize=1)
def rules() -> dict[str, Figure]:
    """What is assumed where nothing is published, by name."""
    file = files("pneumo_ros.parts").joinpath("data/rules.yaml")
    found = {}
    for name, entry in load_yaml(file.read_text(encoding="utf-8")).items():
        sources = {"because": source_text({"title": entry.pop("because")}, name).removesuffix(", year not stated")}
        dimension = entry.pop("dimension")
        figure = figure_of(entry | {"source": "because"}, f"rule {name}", dimension, sources, rule=name)
        found[name] = replace(figure, note=str(entry.get("note", "")))
    return found


@lru_cache(maxsize=1)
def _shipped() -> dict[str, Part]:
    root = Path(str(files("pneumo_ros.parts").joinpath("data")))
    parts = [read_part(path) for kind in ("cylinders", "valves") for path in sorted((root / kind).glob("*.yaml"))]
    return {part.name: replace(part, file=Path(part.file).name) for part in parts}


def _of_folder(folder: Path, option: str) -> list[Part]:
    if not folder.is_dir():
        raise UsageError(f"{option} {folder} is no folder; name a folder that holds part files, *.yaml")
    paths = sorted(folder.glob("*.yaml"))
    if not 0 < len(paths) <= _MOST:
        raise UsageError(f"{option} {folder} holds {len(paths)} part files; it takes 1 to {_MOST}, each *.yaml")
    return [read_part(path) for path in paths]
