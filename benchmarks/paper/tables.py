"""The tables of the paper, beside what the recordings give, as text."""

from collections.abc import Mapping, Sequence

import numpy as np

import pneumo_ros as pn
from benchmarks.paper.bench import CLOSED
from benchmarks.paper.printed import TABLE_1, TABLE_2, Entry

SLIP = (1e-6, 50e-6)  # m, deflections of the bristles while sliding that Eq. 15 allows
REACHED = 0.9  # m, where the advance is timed


def aligned(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Rows of text under a heading, columns as wide as their widest entry."""
    every = [list(head), *(list(row) for row in rows)]
    widths = [max(len(row[k]) for row in every) for k in range(len(head))]
    return "\n".join("  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip()
                     for row in every)  # fmt: skip


def found(result: pn.IdentificationResult, name: str) -> str:
    """An identified value with its 95 % interval, or that the runs do not determine it."""
    one = result.as_dict()["parameters"].get(name)
    if one is None or not one["determined"]:
        return "not determined"
    return f"{one['value']:.5g} ({one['low']:.5g} to {one['high']:.5g})"


def table_1(result: pn.IdentificationResult) -> str:
    """Table 1 as printed, as read, and what the recordings give of it."""
    measured = result.as_dict()["parameters"]
    rows = [
        (one.symbol, one.printed, f"{one.value:.6g}", result.model.specification(one.parameter).unit,
         found(result, one.parameter) if one.parameter in measured else "-", one.note)
        for one in TABLE_1
    ]  # fmt: skip
    return aligned(("", "printed", "read as", "unit", "identified (95 %)", "remark"), rows)


def table_2(result: pn.IdentificationResult) -> str:
    """Table 2 as printed and as identified."""
    rows = [(one.symbol, one.printed, found(result, one.parameter)) for one in TABLE_2]
    return aligned(("", "printed", "identified (95 %)"), [*rows, ("residual of the map, rms", "-", residual(result))])


def as_printed(results: Mapping[str, pn.IdentificationResult]) -> str:
    """Table 2 by Eq. 2 as printed, without the atmosphere on the rod; a column for each of `results`, by heading."""
    rows = [(one.symbol, *(found(result, one.parameter) for result in results.values())) for one in TABLE_2[:4]]
    left = ("residual of the map, rms", *map(residual, results.values()))
    return aligned(("", *results), [*rows, left])


def residual(result: pn.IdentificationResult) -> str:
    """What the fitted map leaves."""
    return f"{result.as_dict()['map']['residual_rms_n']:.2g} N"


def equations_15_16(model: pn.Model) -> str:
    """The bristle's stiffness by Eq. 15, and the bound on its damping that replaces Eq. 16."""
    coulomb, static = model["lugre_friction.coulomb_friction"], model["lugre_friction.static_friction"]
    drag = model["quadratic_drag.coefficient"]
    bound = 2.0 * np.sqrt(drag * coulomb) * static / (static - coulomb)
    least, most = coulomb / SLIP[1], coulomb / SLIP[0]
    return (
        f"Eq. 15: sigma_0 between {least:.3g} and {most:.3g} N/m, for 50 to 1 um; Table 2 takes the lower end\n"
        f"Eq. 16, for a drag in place of sigma_2: sigma_1 at most {bound:.4g} N s/m"
    )


def steady_speeds(pairs: Mapping[str, tuple[pn.Recording, pn.Recording]]) -> str:
    """Speeds and pressures of the last second of a run, recorded and simulated by the identified model."""
    rows = []
    for label, both in pairs.items():
        speeds = [f"{1e3 * last_speed(one):+.1f}" for one in both]
        pressures = [f"{1e-5 * mean(one.pressure_a):.3f}, {1e-5 * mean(one.pressure_b):.3f}" for one in both]
        rows.append((label, *speeds, *pressures))
    return aligned(("voltage", "mm/s recorded", "simulated", "p_a, p_b [bar] recorded", "simulated"), rows)


def last_speed(recording: pn.Recording, seconds: float = 1.0) -> float:
    """Mean speed [m/s] over the last `seconds`, a least-squares slope of the position."""
    late = recording.time > recording.time[-1] - seconds
    return float(np.polyfit(recording.time[late], recording.position[late], 1)[0])


def mean(values: np.ndarray | None, samples: int = 1000) -> float:
    """The mean of the last samples."""
    return float("nan") if values is None else float(np.mean(values[-samples:]))


def arrival(recording: pn.Recording) -> float:
    """Seconds from the step to `REACHED`."""
    return float(recording.time[np.argmax(recording.position > REACHED)]) - CLOSED


def distance(simulated: pn.Recording, recorded: pn.Recording) -> float:
    """Root mean square of the difference of positions [m] until the recorded piston is at `REACHED`."""
    moving = recorded.time < arrival(recorded) + CLOSED
    at = np.interp(recorded.time[moving], simulated.time, simulated.position)
    return float(np.sqrt(np.mean((at - recorded.position[moving]) ** 2)))


def figure_6(recorded: pn.Recording, curves: Mapping[str, pn.Recording]) -> str:
    """When each curve of Fig. 6 reaches 0.9 m, and how far it is from the recorded one."""
    rows = [("(a) recorded", f"{arrival(recorded):.2f}", "-")]
    rows += [(name, f"{arrival(one):.2f}", f"{1e3 * distance(one, recorded):.3g}") for name, one in curves.items()]
    return aligned(("", f"s to {REACHED:g} m", "mm rms from (a)"), rows)


def read_rightly(model: pn.Model) -> list[Entry]:
    """Entries of both tables that a machine file holds with another value; none, if it is read from the print."""
    return [one for one in (*TABLE_1, *TABLE_2) if model[one.parameter] != one.value]
