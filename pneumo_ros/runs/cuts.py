"""Seconds of a recording that are left out of every fit and every judgement."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.runs.run import Run

Cut = tuple[float, float]  # from, to [s] since the first sample
_FORM = re.compile(r"(?P<bag>.+):(?P<begin>\d*\.?\d+)-(?P<end>\d*\.?\d+)")
_LEAST = 50  # samples that must remain


def parse_cuts(given: Sequence[str]) -> dict[Path, tuple[Cut, ...]]:
    """Cuts by the resolved path of their recording, from texts `BAG:FROM-TO` in seconds.

    Raises UsageError for a text of another form, a missing recording, and an end before its beginning.
    """
    found: dict[Path, tuple[Cut, ...]] = {}
    for text in given:
        match = _FORM.fullmatch(text)
        if match is None:
            raise UsageError(f"--cut takes BAG:FROM-TO in seconds, such as run_3:2.5-4; '{text}' is of another form")
        path, begin, end = Path(match["bag"]), float(match["begin"]), float(match["end"])
        if not path.exists():
            raise UsageError(f"--cut {text}: there is no recording {path}")
        if not begin < end:
            raise UsageError(f"--cut {text}: it ends before it begins; type --cut {path}:{end:g}-{begin:g}")
        found[path.resolve()] = (*found.get(path.resolve(), ()), (begin, end))
    return found


def without(run: Run, cuts: Sequence[Cut]) -> Run:
    """`run` with the samples in `cuts` marked as not measured, as in a gap; DataError when too few remain."""
    measured = run.measured.copy()
    for begin, end in cuts:
        measured &= (run.time < begin) | (run.time > end)
    if cuts and measured.sum() < _LEAST:
        raise DataError(f"{run.name}: the cuts leave {int(measured.sum())} samples of {len(run)}; cut less")
    return replace(run, measured=measured) if cuts else run
