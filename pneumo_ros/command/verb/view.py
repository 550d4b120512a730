"""Look at recordings in the terminal: what they contain, each signal over time, and what is wrong with them.

BAG may be a folder of recordings. Exit code 3 when none of them can be read.
"""

import argparse
import io
import shlex
import shutil
import sys
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.again import again
from pneumo_ros.command.arguments import add_output, add_recordings
from pneumo_ros.command.console import Console
from pneumo_ros.command.recordings import expanded, read_options
from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import DataError
from pneumo_ros.measured import MEASURED
from pneumo_ros.units import LINE, unit_along

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pneumo_ros.records import Recording

BLOCKS = " \u2581\u2582\u2583\u2584\u2585\u2586\u2587\u2588"
GAP = "\u00b7"  # nothing was measured there
WIDE = 40  # letters of a sparkline, where the terminal has room
# field of a recording -> words, unit shown, factor from SI
SHOWN = {
    "position": ("position", "mm", 1e3), "velocity": ("velocity", "m/s", 1.0),
    "pressure_a": ("pressure a", "bar", 1e-5), "pressure_b": ("pressure b", "bar", 1e-5),
    "voltage": ("voltage", "V", 1.0), "effort": ("effort", "N", 1.0),
    **{one.name: (one.name.replace("_", " "), *one.shown) for one in MEASURED},
}  # fmt: skip

EXAMPLES = (
    "pneumo view runs",
    "pneumo view run_1 --read-as bar",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """BAG..., how to read them, and the output."""
    parser.add_argument("bags", nargs="+", metavar="BAG", help="recordings, or folders of recordings")
    add_recordings(parser, cut=False)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Read each, print it, and say which could not be read or used; 1 where one cannot be used as it is read."""
    require_libraries(("rich",))
    from pneumo_ros.reading.read import corrected_recording

    how = read_options(options)
    paths, found, problems = expanded(options.bags, console), list[dict[str, Any]](), list[str]()
    for path in paths:
        try:
            recording = corrected_recording(path, how)
        except DataError as problem:
            problems.append(str(problem))
            console.note(f"Passed over: {problem}")
            continue
        wrong = unfit(recording)
        found.append({**summary(recording), "unfit": wrong})
        console.say(text(recording) + (f"\n  Not fit for other verbs: {wrong}" if wrong else ""))
    if not found:
        raise DataError(problems[-1])
    console.next(f"compare {shlex.join(options.bags[:2])}{again(options)}")
    console.json({"schema_version": 1, "recordings": found, "passed_over": problems})
    return int(any(one["unfit"] for one in found))


def unfit(recording: "Recording") -> str:
    """What keeps other verbs from using the recording as it is read, such as pressures in bar; empty if nothing."""
    from pneumo_ros.records.unfit import check_pressures

    try:
        check_pressures(recording, oil=recording.voltage is None)
    except DataError as problem:
        return str(problem)
    return ""


def summary(recording: "Recording") -> dict[str, Any]:
    """One recording for JSON, SI units."""
    import numpy as np

    signals = {}
    for name in SHOWN:
        values = recording.signals.get(name)
        if values is not None:
            signals[name] = {"low": np.nanmin(values), "high": np.nanmax(values), "mean": np.nanmean(values)}
    return {
        "name": recording.name, "path": recording.path, "namespace": recording.namespace,
        "joint": recording.joint_name, "duration_s": recording.duration, "samples": len(recording),
        "sample_time_s": recording.sample_time, "force_driven": recording.force_driven,
        "warnings": list(recording.warnings), "signals": signals,
    }  # fmt: skip


def text(recording: "Recording") -> str:
    """A recording as a table, with a line of blocks for each signal over its time."""
    import numpy as np
    from rich.console import Console as Rich
    from rich.table import Table

    from pneumo_ros.records.recording import coordinate

    columns = shutil.get_terminal_size().columns
    rate = f"{len(recording)} samples at {1.0 / recording.sample_time:.0f} Hz"
    head = f"{recording.name}: {recording.duration:.1f} s, {rate}"
    place = f", namespace {recording.namespace}" if recording.namespace else ""
    table = Table(title=head + place, title_justify="left", title_style="bold")
    for name in ("signal", "lowest", "mean", "highest"):
        table.add_column(name, justify="left" if name == "signal" else "right", no_wrap=True)
    moves = coordinate(recording.description)
    width = min(max(columns - (56 if moves == LINE else 66), 10), WIDE)  # rad/s and mrad are longer
    table.add_column(f"0 to {recording.duration:.1f} s", no_wrap=True)
    for name, (words, unit, factor) in SHOWN.items():
        values = recording.signals.get(name)
        if values is not None:
            own, picks = unit_along(unit, moves), (np.nanmin, np.nanmean, np.nanmax)
            numbers = (f"{factor * pick(values):.4g} {own}" for pick in picks)
            table.add_row(words, *numbers, sparkline(recording.time, values, width))
    stream = io.StringIO()
    rich = Rich(file=stream, width=columns, force_terminal=sys.stdout.isatty(), highlight=False)
    rich.print(table)
    for warning in recording.warnings:
        rich.print(f"  {warning}", markup=False, soft_wrap=True)
    return stream.getvalue().rstrip("\n")


def sparkline(time: "NDArray[np.float64]", values: "NDArray[np.float64]", width: int) -> str:
    """Values (n,) over time (n,) as `width` blocks, each as high as the mean of its part; a dot without values."""
    import numpy as np

    place = np.minimum(((time - time[0]) / (time[-1] - time[0]) * width).astype(int), width - 1)
    good = np.isfinite(values)
    count = np.bincount(place[good], minlength=width)
    mean = np.bincount(place[good], values[good], minlength=width) / np.maximum(count, 1)
    low, high = mean[count > 0].min(), mean[count > 0].max()
    rise = (mean - low) / (high - low) if high > low else np.full(width, 0.5)
    level = np.clip(1 + np.floor(rise * 8.0), 1, 8).astype(int)
    return "".join(BLOCKS[k] if n else GAP for k, n in zip(level.tolist(), count.tolist(), strict=True))
