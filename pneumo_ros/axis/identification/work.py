"""The identification as a program: a job in JSON on stdin, progress and result as JSON lines on stdout. No ROS.

It is a process of its own: numba and numpy block the interpreter for long, and a node must answer.
"""

import json
import math
import os
import sys
import time
from collections.abc import Callable
from typing import Any

from pneumo_ros.compare.moved import refit_dict
from pneumo_ros.errors import PneumoError
from pneumo_ros.identify.campaign import identify
from pneumo_ros.identify.summary import summary
from pneumo_ros.plant import Library, Model, model_from_dict
from pneumo_ros.plant.mechanical import whole
from pneumo_ros.reading.read import ReadOptions, read_runs
from pneumo_ros.runs.inputs import check_driven, judged, measuring
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.refit import refit
from pneumo_ros.units import write_in

NICE = 5  # control loops come first
PARTS = (0.0, 0.2, 1.0)  # of the progress: reading, identifying
PARTS_WITH_REFIT = (0.0, 0.1, 0.4, 1.0)


class Report:
    """Writes lines; progress no more than a hundred of them."""

    def __init__(self) -> None:
        self._percent = -1

    def line(self, **content: object) -> None:
        """One line; numbers that are not finite become null."""
        print(json.dumps(plain(content), allow_nan=False), flush=True)

    def part(self, begin: float, end: float) -> Callable[[float, str], None]:
        """Progress of a part of the work, which goes from `begin` to `end` of the whole."""

        def tell(share: float, text: str) -> None:
            percent = int(100 * (begin + (end - begin) * min(max(share, 0.0), 1.0)))
            if percent > self._percent:
                self._percent = percent
                self.line(progress=percent, text=text)

        return tell


def plain(value: Any) -> Any:
    """`value` with NaN and infinities as None, numpy's numbers and arrays as Python's."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [plain(inner) for inner in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value


def work(job: dict[str, Any], report: Report) -> dict[str, Any]:
    """The result of a job: `machine` and `name` of the model, `files` with effects, `bags`, `whole_model`.

    `axis` and `joint_name` choose where a recording holds several; otherwise they are empty. `words` are those of
    --read-as. Raises DataError when no recording can be used, and what identification raises.
    """
    begun = time.monotonic()
    parts = PARTS_WITH_REFIT if job["whole_model"] else PARTS
    model = model_from_dict(job["machine"], job["name"], Library(job["files"]))
    write_in(model.coordinate)
    runs, refused = read(job, model, report, report.part(*parts[0:2]))
    given, model = model, measuring(model, runs)
    check_driven(model, runs)
    found = identify(model, runs, progress=report.part(*parts[1:3]))
    result = summary(found, runs) | {"refused_recordings": refused, "recordings": [run.name for run in runs]}
    result["judged"] = judged(model, runs)
    after: Model = found.model
    if job["whole_model"]:
        refitted = refit(after, runs, progress=report.part(*parts[2:4]))
        after = refitted.model
        result["refit"] = refit_dict(refitted, [run.name for run in runs])
    return result | {"machine": whole(given, after).as_dict(), "took_s": time.monotonic() - begun}


def read(
    job: dict[str, Any], model: Model, report: Report, progress: Callable[[float, str], None]
) -> tuple[list[Run], dict[str, str]]:
    """The runs of a job's recordings, and by path the reasons why others are refused; see `read_runs`."""
    found = read_runs(
        job["bags"],
        model,
        ReadOptions(job["axis"] or None, job["joint_name"] or None, tuple(job.get("words", ())), mechanics=True),
        progress=lambda share: progress(share, "reading recordings"),
        note=lambda text: report.line(warning=text),
        refuse=lambda path, reason: report.line(refused=path, reason=reason),
    )
    return found.runs, dict(found.refused)


def main() -> int:
    """Read the job, run it, write the result or the reason of its failure."""
    os.nice(NICE)
    report = Report()
    try:
        report.line(result=work(json.load(sys.stdin), report))
    except PneumoError as error:
        report.line(failed=str(error))
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
