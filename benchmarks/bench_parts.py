"""How often the band that `pneumo new` predicts for a stroke holds the stroke of a rig drawn within the stated scatter.

Rigs of several designs have figures drawn evenly from the intervals of their sources and rules: flow, critical ratio,
friction, breakaway, seals, dead volume, spool, and how a proportional valve opens. The band is made of other machines
drawn in the same way, so it holds 95 % of the rigs but for chance: what may fail is a band that is too wide, or a draw
that leaves out what a rig has. `width` is its width over that of the span of rigs. The table counts the rigs whose
stroke time, out and back at full signal, lies within the band. With --ends every figure lies at one end of its
interval: rigs as far off as the sources allow. Rig and machine have the same equations: this judges the stated
uncertainty, not what the model lacks.

    python benchmarks/bench_parts.py [--rigs 200] [--seed 1] [--ends]
"""

import argparse
import time

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.parts.assemble import parameters
from pneumo_ros.parts.design import Design, Wishes, design
from pneumo_ros.parts.figure import Figure
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.parts.strokes import band, stroke_times

Array = NDArray[np.float64]
ROW = "{:<16} {:<16} {:<4} {:>9} {:>16} {:>16} {:>6} {:>7}"
DESIGNS = (
    Wishes(cylinder="iso15552-32-250", valve="smc-sy7000", supply="6barg", mass="10kg", mounting="vertical"),
    Wishes(cylinder="iso15552-50-320", valve="airtac-4v210", supply="6barg", mass="30kg"),
    Wishes(cylinder="iso6432-25-200", valve="smc-vq1000-metal", supply="5barg", mass="2kg"),
    Wishes(cylinder="iso6432-16-100", valve="festo-mh2-ms1h", supply="6barg", mass="0.5kg", mounting="vertical-down"),
    Wishes(bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min", supply="6barg", mass="2kg"),
)


def rigs(made: Design, count: int, random: np.random.Generator, at_ends: bool) -> Array:
    """Parameter vectors (count, parameters) of rigs whose figures lie anywhere in their intervals, or at their ends."""
    names = list(made.model.parameters)
    found = np.tile(made.model.values, (count, 1))
    for row in found:
        drawn = {key: _drawn(figure, random, at_ends) for key, figure in made.order.figures.items()}
        for name, value in parameters(made.order, made.order.nominal | drawn).items():
            if name in made.model.uncertainty:
                row[names.index(name)] = value
    return found


def _drawn(figure: Figure, random: np.random.Generator, at_ends: bool) -> float:
    return float(random.choice([figure.low, figure.high]) if at_ends else random.uniform(figure.low, figure.high))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rigs", type=int, default=200, help="rigs of all designs together (default: 200)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--ends", action="store_true", help="every figure at one end of its interval")
    options = parser.parse_args()
    shelf, random, begun = load_shelf(), np.random.default_rng(options.seed), time.monotonic()
    each, total, held = max(1, options.rigs // len(DESIGNS)), 0, [0, 0, 0]
    heads = ("cylinder", "valve", "way", "predicted", "95 % band", "rigs", "width", "within")
    print(ROW.format(*heads))
    for said in DESIGNS:
        made = design(said, shelf)
        drawn, inside = rigs(made, each, random, options.ends), []
        for way, signal in zip(("out", "back"), made.signal, strict=True):
            value, low, high = band(made, signal)
            times = stroke_times(made.model, signal, drawn)
            inside.append((times >= low) & (times <= high))
            span = f"{times.min():.3f} to {times.max():.3f} s"
            width = f"{(high - low) / (times.max() - times.min()):.2f}"
            cylinder = said.cylinder or f"{said.bore}/{said.rod}-{said.stroke}"
            names = (cylinder, said.valve or said.valve_flow) if way == "out" else ("", "")
            said_band = f"{low:.3f} to {high:.3f} s"
            print(ROW.format(*names, way, f"{value:.3f} s", said_band, span, width, f"{int(inside[-1].sum())}/{each}"))
        total += each
        held = [h + int(i.sum()) for h, i in zip(held, (*inside, inside[0] & inside[1]), strict=True)]
    out, back, both = (f"{count} ({100 * count / total:.0f} %)" for count in held)
    print(f"\n{total} rigs: within the band out {out}, back {back}, both {both}; {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    main()
