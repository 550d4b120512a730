"""Wrong wiring: how often `pneumo rig check` names it, over every combination and machines drawn at random.

Usage: python benchmarks/bench_plumbing.py [--machines 5]

Swapped chambers, reversed position, reversed command, gauge pressures, the encoder's zero at mid stroke or at the left
or right end: 48 combinations; units of pressure and length and a closed signal of 0 or 5 V are drawn. The guess knows
the machine as a data sheet tells it: mass, friction, flow and volumes 20 % off.
"""

import argparse
import itertools
import time

import numpy as np

import pneumo_ros as pn
from pneumo_ros.errors import PneumoError
from pneumo_ros.reading.rig_guess import guess_rig
from pneumo_ros.records.corrections import PRESSURE_UNITS, corrected

NOISE = {"position": 5e-6, "pressure_a": 300.0, "pressure_b": 300.0}  # m, Pa
ROUGH = (
    "piston.mass", "lugre_friction.coulomb_friction", "arctan_flow.filling_coefficient",
    "arctan_flow.exhaust_coefficient", "chambers.volume_a", "chambers.volume_b",
)  # fmt: skip


def wired(
    right: pn.Recording, words: list[str], scale: float, length: float, stroke: float, closed: float
) -> pn.Recording:
    """The recording as a rig wired by `words` would have made it."""
    from dataclasses import replace

    zero = {"left": -0.5 * stroke, "right": 0.5 * stroke}.get(
        next((w for w in words if w in ("left", "right")), ""), 0.0
    )
    sign = -1.0 if "reversed-position" in words else 1.0
    flip = -1.0 if "reversed-voltage" in words else 1.0
    rise = -1e5 if "gauge" in words else 0.0
    a, b = (right.pressure_b, right.pressure_a) if "swapped-chambers" in words else (right.pressure_a, right.pressure_b)
    return replace(
        right,
        position=(sign * right.position + zero) / length,
        pressure_a=(a + rise) / scale,
        pressure_b=(b + rise) / scale,
        voltage=flip * right.voltage + closed,
        command=flip * right.command + closed,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--machines", type=int, default=5, help="for each of the 48 combinations")
    options = parser.parse_args()
    axis = pn.load_model("axis")
    named, wrong, spent, first = 0, [], [], 0
    for seed in range(options.machines):
        random = np.random.default_rng(seed)
        stroke = float(random.uniform(0.2, 0.6))
        areas = {name: axis[f"piston.{name}"] * float(random.uniform(0.7, 2.0)) for name in ("area_a",)}
        areas["area_b"] = areas["area_a"] * float(random.uniform(0.65, 0.9))
        values = {f"piston.{name}": area for name, area in areas.items()} | {"piston.stroke": stroke}
        for side in "ab":
            values[f"chambers.volume_{side}"] = areas[f"area_{side}"] * stroke * 0.5 + float(random.uniform(2e-5, 8e-5))
        truth = axis.with_parameters(values)
        known = truth.with_parameters(
            {n: truth[n] * float(random.uniform(0.85, 1.2)) for n in ROUGH if not n.startswith("chambers")}
            | {n: truth[n] * float(random.uniform(1.0, 1.2)) for n in ROUGH if n.startswith("chambers")}
        )
        amplitude = float(random.uniform(2.0, 3.5))
        right = pn.simulate(truth, f"sine:{amplitude},{random.uniform(0.5, 1.0)}", seconds=8.0, noise=NOISE, seed=seed)
        for choice in itertools.product(
            ("", "swapped-chambers"),
            ("", "reversed-position"),
            ("", "reversed-voltage"),
            ("", "gauge"),
            ("", "left", "right"),
        ):
            words = [word for word in choice if word]
            unit = ["Pa", *PRESSURE_UNITS][int(random.integers(0, 6))]
            length = 1e-3 if random.random() < 0.5 else 1.0
            closed = 5.0 if random.random() < 0.5 else 0.0
            given = wired(right, words, PRESSURE_UNITS.get(unit, 1.0), length, stroke, closed)
            begin = time.perf_counter()
            first += 1
            try:
                found = guess_rig(given, known).best
                mended = corrected(given, found.words, 1e5)
                off = float(np.abs(mended.position - right.position).max()) / stroke
                off += sum(
                    float(np.abs(x - y).max()) / 1e5
                    for x, y in ((mended.pressure_a, right.pressure_a), (mended.pressure_b, right.pressure_b))
                )
                off += float(np.abs(mended.voltage - right.voltage).max()) / 10.0
                good = off < 0.02
            except PneumoError as error:
                good, found = False, error
            spent.append(time.perf_counter() - begin)
            named += good
            if not good:
                wrong.append((seed, words, unit, length, closed, getattr(found, "words", found)))
    print(f"named: {named} of {first}; {np.median(spent):.1f} s each (median), worst {max(spent):.1f} s")
    for one in wrong[:20]:
        print("  missed:", *one)


if __name__ == "__main__":
    main()
