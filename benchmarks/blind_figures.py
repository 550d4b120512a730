"""Figures of the blind benchmark: parameters of added effects, held-out errors, cost."""

import statistics
from collections import defaultdict
from collections.abc import Callable, Sequence

import numpy as np
from blind_case import PARTNER
from blind_tables import EMPTY, HIDING, Result, Z, of_kind, rate

Row = tuple[float, float, float | None]  # truth, value, standard deviation or None where it is not determined
HELD_OUT, WITHIN, SECONDS, MEGABYTES = 1.3, 0.05, (30.0, 75.0, 150.0), 1000.0


def parameters_table(results: Sequence[Result]) -> str:
    """Errors and intervals of the parameters of added effects, where rig and catalogue mean the same."""
    rows: dict[str, list[Row]] = defaultdict(list)
    for result in results:
        for added in result["added"]:
            for key, truth in result["true_parameters"].get(added["effect"], {}).items():
                value, std = added["parameters"][key]
                rows[f"{added['effect']}.{key}"].append((truth, value, std))
    names = ("n", "median error", "worst", "within 5 %", "interval holds it", "undetermined")
    lines = [f"{'parameters of added effects':48s}" + "".join(f"{name:>22s}" for name in names)]
    for name in sorted(rows):
        lines.append(_parameter(name, rows[name]))
    every = [row for values in rows.values() for row in values]
    if every:
        lines.append(_parameter("all", every) + "   (targets: within 5 % in 92 %; held in 92 to 98 %)")
    return "\n".join(lines)


def _parameter(name: str, rows: Sequence[Row]) -> str:
    known = [(truth, value, std) for truth, value, std in rows if std is not None]
    errors = [abs(value / truth - 1.0) for truth, value, _ in known if truth]  # a truth of zero has no relative error
    within = rate(sum(error <= WITHIN for error in errors), len(errors))
    held = rate(sum(abs(value - truth) <= Z * std for truth, value, std in known), len(known))
    middle = f"{100.0 * statistics.median(errors):.2f} %" if errors else "-"
    worst = f"{100.0 * max(errors):.1f} %" if errors else "-"
    cells = (str(len(rows)), middle, worst, within, held, str(len(rows) - len(known)))
    return f"{name:48s}" + "".join(f"{cell:>22s}" for cell in cells)


def held_out_table(results: Sequence[Result]) -> str:
    """Held-out error after adding, in noise floors and against that of the healthy machine of the same seed."""
    floor = {(r["kind"], r["seed"]): min(error for _, error in r["course"][1:]) for r in of_kind(results, *EMPTY)}
    lines = [
        "held-out 1 s error after adding, and over the healthy machine's (same seed, refitted; target: at most 1.3)"
    ]
    if floor:
        lines.append(f"  {'nothing hidden':24s}{spread(list(floor.values()))} noise floors")
    for same, title in ((True, "shape in the catalogue"), (False, "another shape")):
        some = [r for r in of_kind(results, *HIDING) if all(h["same_shape"] for h in r["hidden"]) is same]
        if some:
            lines.append(f"  {title:24s}{spread([r['course'][-1][1] for r in some])} noise floors")
        pairs = [(r["course"][-1][1], floor.get((PARTNER[r["kind"]], r["seed"]))) for r in some]
        ratios = [error / least for error, least in pairs if least]
        if ratios:
            ok = rate(sum(ratio <= HELD_OUT for ratio in ratios), len(ratios))
            lines.append(f"  {'  over the healthy one':24s}{spread(ratios)}, at most {HELD_OUT:g}: {ok}")
        if len(ratios) < len(some):
            missing = len(some) - len(ratios)
            lines.append(f"    {missing} without it: run the same seeds with --kind healthy or rough_healthy")
    return "\n".join(lines)


def spread(values: Sequence[float]) -> str:
    """Median and worst."""
    return f"median {statistics.median(values):.2f}, worst {max(values):.2f}"


def cost_table(results: Sequence[Result]) -> str:
    """Time and memory; times for 150 s of recordings are scaled by their length."""
    shown: dict[str, Callable[[Result], float]] = {
        "wall [s]": lambda r: r["wall"],
        "processor [s]": lambda r: r["processor"],
        "wall for 150 s [s]": lambda r: r["wall"] * 150.0 / r["recorded"],
        "memory peak [MB]": lambda r: r["peak_mb"],
    }
    targets = {
        "wall for 150 s [s]": "under {:g}, {:g} and {:g} on 2 processors with nothing beside it".format(*SECONDS),
        "memory peak [MB]": f"under {MEGABYTES:g}",
    }
    lines = [f"cost of a diagnosis{'median':>17s}{'95 % under':>12s}{'worst':>12s}"]
    for name, value in shown.items():
        values = [value(result) for result in results]
        target = f"   (target: {targets[name]})" if name in targets else ""
        middle, most = statistics.median(values), float(np.quantile(values, 0.95))
        lines.append(f"  {name:22s}{middle:12.1f}{most:12.1f}{max(values):12.1f}{target}")
    return "\n".join(lines)
