"""Variants of a machine: its parent, the verb that made it, and its comparison with the recordings."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.compare import typical
from pneumo_ros.plant import Model, load_model
from pneumo_ros.plant.axes_section import place_of


@dataclass(frozen=True)
class Compared:
    """Output of `pneumo compare` for bags, by name, in the order given: its JSON, its series and its report.

    `line` is the command line that wrote them.
    """

    bags: tuple[str, ...]
    json: Path
    series: Path
    report: Path
    line: str = ""

    @property
    def result(self) -> dict[str, Any]:
        """The JSON."""
        return _json(self.json)

    def run(self, name: str) -> int | None:
        """The number of a run in the series, counted from 1; None when it was not compared."""
        return self.bags.index(name) + 1 if name in self.bags else None

    def array(self, key: str) -> NDArray[Any]:
        """One array of the series; KeyError when there is none of that name."""
        return _array(self.series, key)


@dataclass(frozen=True)
class Variant:
    """A machine file on a desk. `lines` are the command lines that make it from its parent; comments begin with #."""

    number: int
    machine: str  # for --model, relative to the desk's folder
    label: str
    parent: int | None = None
    lines: tuple[str, ...] = ()
    result: Path | None = None  # JSON of the verb that made it
    report: Path | None = None
    compared: Compared | None = None

    def made_by(self) -> dict[str, Any]:
        """The JSON of the verb that made it; empty without one."""
        return _json(self.result) if self.result else {}


@lru_cache(64)
def _json(path: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


@lru_cache(64)
def _array(path: Path, key: str) -> NDArray[Any]:
    with np.load(path) as series:
        found: NDArray[Any] = series[key]
    return found


def model_of(machine: str, folder: Path, effects: Sequence[str]) -> Model:
    """The model of a machine file relative to `folder`, or of a shipped one; UsageError as `load_model`."""
    file, axis = place_of(machine)
    path = folder / file
    own = f"{path}:{axis}" if axis else str(path)
    return load_model(own if path.is_file() else machine, effects_files=tuple(effects))


def runs_of(compared: Compared, bags: Sequence[str]) -> list[Mapping[str, Any]]:
    """The runs of `bags` in the result of a comparison."""
    runs = zip(compared.bags, compared.result["runs"], strict=True)
    return [run for name, run in runs if name in bags]


def typical_error(compared: Compared, bags: Sequence[str]) -> float | None:
    """Error of a typical window over `bags` in noise floors, as in `pneumo diagnose`; None without them."""
    return typical.typical_error(runs_of(compared, bags))
