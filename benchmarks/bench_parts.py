"""How often the band that `pneumo new` predicts for a stroke holds the stroke of a rig drawn within the stated scatter.

Rigs of several designs have figures drawn evenly from the intervals of their sources and rules: flow, critical ratio,
friction, breakaway, seals, dead volume, spool. Each rig is made of its figures, so sizes that belong together, such as
both friction forces, are drawn together; the machine file knows only one deviation for each parameter. The table counts
the rigs whose stroke time, out and back at full signal, lies within the 95 % band of the machine file. Rig and machine
have the same equations: this judges the stated uncertainty, not what the model lacks.

    python benchmarks/bench_parts.py [--rigs 200] [--seed 1]
"""

import argparse
import time

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.parts.assemble import parameters
from pneumo_ros.parts.design import Design, Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.parts.strokes import band, stroke_times

Array = NDArray[np.float64]
DESIGNS = (
    Wishes(cylinder="iso15552-32-250", valve="smc-sy7000", supply="6barg", mass="10kg", mounting="vertical"),
    Wishes(cylinder="iso15552-50-320", valve="airtac-4v210", supply="6barg", mass="30kg"),
    Wishes(cylinder="iso6432-25-200", valve="smc-vq1000-metal", supply="5barg", mass="2kg"),
    Wishes(cylinder="iso6432-16-100", valve="festo-mh2-ms1h", supply="6barg", mass="0.5kg", mounting="vertical-down"),
)


def rigs(made: Design, count: int, random: np.random.Generator) -> Array:
    """Parameter vectors (count, parameters) of rigs whose figures lie anywhere in their intervals."""
    names = list(made.model.parameters)
    found = np.tile(made.model.values, (count, 1))
    for row in found:
        drawn = {key: float(random.uniform(f.low, f.high)) for key, f in made.order.figures.items()}
        for name, value in parameters(made.order, made.order.nominal | drawn).items():
            if name in made.model.uncertainty:
                row[names.index(name)] = value
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rigs", type=int, default=200, help="rigs of all designs together (default: 200)")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    shelf, random, begun = load_shelf(), np.random.default_rng(options.seed), time.monotonic()
    each, total, held = max(1, options.rigs // len(DESIGNS)), 0, [0, 0, 0]
    print(f"{'cylinder':<17} {'valve':<17} {'way':<5} {'predicted':>9} {'95 % band':>17} {'rigs':>17} {'within':>9}")
    for said in DESIGNS:
        made = design(said, shelf)
        drawn, inside = rigs(made, each, random), []
        for way, signal in zip(("out", "back"), made.signal, strict=True):
            value, low, high = band(made.model, signal)
            times = stroke_times(made.model, signal, drawn)
            inside.append((times >= low) & (times <= high))
            span = f"{times.min():.3f} to {times.max():.3f} s"
            names = f"{said.cylinder:<17} {said.valve:<17}" if way == "out" else " " * 35
            count = f"{int(inside[-1].sum())}/{each}"
            print(f"{names} {way:<5} {value:7.3f} s {f'{low:.3f} to {high:.3f} s':>17} {span:>17} {count:>9}")
        total += each
        held = [h + int(i.sum()) for h, i in zip(held, (*inside, inside[0] & inside[1]), strict=True)]
    out, back, both = (f"{count} ({100 * count / total:.0f} %)" for count in held)
    print(f"\n{total} rigs: within the band out {out}, back {back}, both {both}; {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    main()
