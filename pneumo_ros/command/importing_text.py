"""What `pneumo import` says: tables as they became recordings, and guesses of what their columns are."""

from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import columns

if TYPE_CHECKING:
    from pathlib import Path

    from pneumo_ros.tables.guess import Guesses
    from pneumo_ros.tables.importing import Imported


def summary(found: "Imported", path: "Path") -> dict[str, Any]:
    """One recording for JSON, SI units."""
    import numpy as np

    signals = dict(found.signals)
    if found.command is not None:
        signals["command"] = found.command[1]
    return {
        "table": found.table.path, "bag": path, "samples": len(found.time), "rate_hz": found.rate,
        "duration_s": float(found.time[-1] - found.time[0]), "imposed": found.plan.imposed,
        "clock": {
            "median_s": found.clock.median, "within_90_percent_s": found.clock.within,
            "longest_s": found.clock.longest, "even": found.clock.even, "rows": len(found.table),
        },
        "signals": {
            name: {
                "columns": found.origins[name], "unit": found.units[name], "low": float(np.min(values)),
                "high": float(np.max(values)),
            }
            for name, values in signals.items()
        },
        "notes": found.notes,
    }  # fmt: skip


def imported_text(told: dict[str, Any], words: str) -> str:
    """One recording as a table: each signal with its columns and its range."""
    clock = "even clock" if told["clock"]["even"] else "uneven clock"
    head = (
        f"{told['table'].name} -> {told['bag']}: {told['samples']} samples, {told['duration_s']:.1f} s at "
        f"{told['rate_hz']:.4g} Hz\n  {clock}: {words}" + ("; imposed motion" if told["imposed"] else "")
    )
    rows = [
        (f"  {name}", one["columns"], f"{one['low']:.4g}", f"{one['high']:.4g}", one["unit"])
        for name, one in told["signals"].items()
    ]
    return f"{head}\n{columns([('  signal', 'column', 'lowest', 'highest', 'unit'), *rows], right=(2, 3))}"


def guess_text(found: "Guesses") -> str:
    """A guess as a table, and what is open."""
    rows = [("  signal", "column", "unit", "lowest", "highest", "why")]
    if found.time is not None:
        rows.append(("  time", found.time.column, found.time.unit, "", "", found.time.why))
    for name, one in found.signals.items():
        gauge = "" if one.gauge is None else " gauge" if one.gauge else " absolute"
        rows.append((f"  {name}", one.column, one.unit + gauge, f"{one.low:.4g}", f"{one.high:.4g}", one.why))
    lines = [columns(rows, right=(3, 4)), f"  motion: {'imposed' if found.imposed else 'free'}"]
    lines += [f"  not used: {', '.join(found.unused)}"] if found.unused else []
    lines += [f"  not decided: {sentence}" for sentence in found.open]
    return "\n".join(lines)


def guess_json(found: "Guesses") -> dict[str, Any]:
    """A guess for JSON."""
    return {
        "time": None if found.time is None else found.time._asdict(),
        "signals": {name: vars(one) for name, one in found.signals.items()},
        "imposed": found.imposed, "unused": found.unused, "open": found.open, "complete": found.complete,
    }  # fmt: skip
