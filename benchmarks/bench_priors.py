"""How many recordings the priors of data sheets save: recordings needed for equal intervals, with them and without.

Usage: python benchmarks/bench_priors.py [--rigs 20] [--first-seed 0]

Rigs as in bench_commission.py --figures: a cylinder of 25/10 mm with a stroke of 200 mm and a valve of 700 l/min, each
figure anywhere in the interval of its source. Each rig is recorded by the moves of a commissioning, 5 to 25 s each, in
an order drawn anew. The intervals are those of the equations along the motion of the first 1, 2, ... recordings, with
the uncertainty that `pneumo new` states and with one of ten times as much: the order of magnitude is known, and nothing
more. Commissioning reaches such intervals (`achieved over predicted` of bench_commission.py). `width` is the geometric
mean of the standard deviations of all parameters that equations show, over those of the data sheet. `needed` is how
many recordings give the width with the data sheet that so many give without it, between two counts by its logarithm.
"""

import argparse
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from bench_commission import data_sheet, rig_of_figures
from numpy.typing import NDArray

from pneumo_ros.commission import moves
from pneumo_ros.commission.information import Told, told
from pneumo_ros.commission.safe import safe
from pneumo_ros.commission.simulated import SimulatedRig
from pneumo_ros.commission.slips import surely_static
from pneumo_ros.commission.wiring import as_run
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.refit import default_free, default_prior

Array = NDArray[np.float64]
WIDER = 10.0  # times the deviations of the data sheet: nothing but the order of magnitude is known


def recorded(model: Model, rig: SimulatedRig, seed: int) -> list[list[Run]]:
    """The runs of each recording, in an order drawn at random; the rig begins each of them at mid stroke."""
    programmes = [one for one in (safe(made, [rig.truth]) for made in moves.candidates(rig.truth, seed)) if one]
    found = list[list[Run]]()
    for number, k in enumerate(np.random.default_rng([seed, 9]).permutation(len(programmes))):
        done = replace(rig, seed=100 * seed + number, position=0.0).perform(programmes[k], (), f"recording_{number}")
        found.append([as_run(one, model, ()) for one in done.recordings])
    return [runs for runs in found if runs]


def widths(sheet: Model, truth: Model, recordings: Sequence[Sequence[Run]], wider: float) -> list[float]:
    """Geometric mean of the deviations over the data sheet's after each recording; priors `wider` than it says."""
    runs = [run for part in recordings for run in part]
    known = Fitter(sheet, runs[:1], candidates=()).known(sheet)
    evidence = surely_static(Evidence(sheet, runs), truth)
    whole, found = told(evidence, truth, known), list[float]()
    for count in np.cumsum([len(part) for part in recordings]):
        rows = evidence.run < count
        some = Told(whole.slopes[rows] * wider, whole.residual[rows], whole.block[rows], whole.scales)
        found.append(float(np.exp(np.mean(np.log(some.deviations() * wider)))))
    return found


def needed(reached: Sequence[float], wanted: float) -> float:
    """How many recordings reach a width: reached[k] is that after k + 1; infinite where none does."""
    before = 1.0  # of the data sheet
    if wanted >= before:
        return 0.0
    for k, one in enumerate(reached):
        if one <= wanted:
            return float(k + np.log(before / wanted) / np.log(before / one))
        before = one
    return float("inf")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rigs", type=int, default=20)
    parser.add_argument("--first-seed", type=int, default=0)
    options = parser.parse_args()
    bare = data_sheet()
    sheet = bare.with_uncertainty({name: default_prior(bare, name) for name in default_free(bare)})
    rows = dict[int, list[tuple[float, float, float]]]()
    for seed in range(options.first_seed, options.first_seed + options.rigs):
        rig = rig_of_figures(sheet, seed)
        recordings = recorded(sheet, rig, seed)
        own, without = (widths(sheet, rig.truth, recordings, wider) for wider in (1.0, WIDER))
        for k, wanted in enumerate(without):
            rows.setdefault(k + 1, []).append((wanted, own[k], needed(own, wanted)))
    print("recordings  width without  width with  needed with it (medians)  10 to 90 % of rigs")
    for count, of_rigs in sorted(rows.items()):
        without, with_it, with_needed = np.median(of_rigs, axis=0)
        low, high = np.quantile([one[2] for one in of_rigs], [0.1, 0.9])
        print(f"{count:10d} {without:14.3f} {with_it:11.3f} {with_needed:15.1f} {low:18.1f} to {high:.1f}")
    shares = np.array([one[2] / count for count, of_rigs in rows.items() for one in of_rigs])
    print(f"needed over recordings: median {np.median(shares):.2f}   (target: at most 0.5)")


if __name__ == "__main__":
    main()
