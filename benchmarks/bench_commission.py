"""Commissioning of rigs that differ from their data sheets: wiring found, limits kept, intervals narrowed.

Usage: python benchmarks/bench_commission.py [--rigs 10] [--plugs 10] [--limits 20] [--second 2] [--first-seed 0]
       [--price 0] [--known-valve] [--figures]

A cylinder of 25/10 mm with a stroke of 200 mm and a valve of 700 l/min, as `pneumo new` makes it. Every rig is drawn
within the scatter of these figures, has sensors with noise at 500 Hz, stands anywhere in the middle of its stroke, and
is moved by the conductor that moves real ones. Rigs whose friction takes 60 % of the force are drawn anew. Parameters
are drawn by their deviations, each by itself and beyond what the sources allow: static friction of seven times that in
motion, a valve that opens within 30 mV. With --figures, each figure of the sources lies anywhere in its interval.

plugs: each of 48 combinations of swapped chambers, reversed position, reversed command, gauge sensors and the encoder's
zero, for so many rigs; the unit of pressure is given, that of the position is not.
rigs: whole commissionings of three minutes; the same machine with the 16 constant voltages for comparison. A parameter
that neither determines keeps the deviation of the data sheet in both: the ratio is printed over all, where these count
as 1, and over those that one of them determines, to less than half of that deviation. Which truths lie outside their
intervals is printed.
price: minutes that the three uncertain numbers of the valve cost, both limits of its dead zone and its gain: rigs that
have those of the file are commissioned twice, once with a file that says so. Printed is after how many minutes of moves
all other parameters of the fit are as narrow (geometric mean) with the usual file as with the other one.
limits: stages 0 to 2 alone, for whether the piston reaches the end of its stroke.
second: as rigs, with the second simulator (test/rig), which shares no code with the package, as the rig: the default
machine worn by up to 20 %, known to 12 %.
"""

import argparse
import itertools
import sys
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from pneumo_ros.commission import moves
from pneumo_ros.commission.commission import Commissioning
from pneumo_ros.commission.information import knowledge
from pneumo_ros.commission.safe import safe
from pneumo_ros.commission.simulated import SimulatedRig
from pneumo_ros.commission.wiring import as_run
from pneumo_ros.errors import NumericalError, PneumoError
from pneumo_ros.experiment.catalogue import make_programme
from pneumo_ros.parts.assemble import parameters
from pneumo_ros.parts.design import Wishes, design
from pneumo_ros.parts.shelf import load_shelf
from pneumo_ros.plant import Model
from pneumo_ros.records.corrections import PRESSURE_UNITS
from pneumo_ros.shooting.refit import default_free, default_prior

MINUTES, FRICTION = 3.0, 0.6  # min; share of the force
UNSTATED, SURE = ("dead_zone.", "arctan_flow.voltage_gain"), 1e-4  # of the valve, in no data sheet; as known [V, 1/V]
WISHES = Wishes(supply="6barg", mass="2", bore="25", rod="10", stroke="200", valve_flow="qn 700 l/min")
COMBINATIONS = tuple(
    tuple(word for word in choice if word)
    for choice in itertools.product(
        ("", "swapped-chambers"), ("", "reversed-position"), ("", "reversed-voltage"), ("", "gauge"),
        ("", "zero=100mm", "zero=-100mm"),
    )
)  # fmt: skip


def data_sheet() -> Model:
    """The machine as its data sheets tell it."""
    return design(WISHES, load_shelf([])).model


def rig_of(model: Model, seed: int, words: tuple[str, ...] = ()) -> SimulatedRig:
    """A rig within the scatter of the data sheets."""
    random = np.random.default_rng(seed)
    wide = {name: default_prior(model, name) for name in default_free(model)}
    drawn = (truth for again in range(20) for truth in moves.drawn(model, wide, 1, seed + 100_000 * again))
    truth = next(one for one in drawn if _movable(one) and _integrable(one))
    return SimulatedRig(truth, words, seed=seed, position=float(random.uniform(-0.04, 0.04)))


def rig_of_figures(model: Model, seed: int, words: tuple[str, ...] = ()) -> SimulatedRig:
    """A rig whose figures lie anywhere in the intervals of their sources."""
    random, order = np.random.default_rng([seed, 7]), design(WISHES, load_shelf([])).order
    figures = order.figures.items()
    for _ in range(20):
        drawn = {key: float(random.uniform(figure.low, figure.high)) for key, figure in figures}
        values = parameters(order, order.nominal | drawn)
        truth = model.with_parameters({name: values[name] for name in model.uncertainty if name in values})
        if _movable(truth) and _integrable(truth):
            break
    return SimulatedRig(truth, words, seed=seed, position=float(random.uniform(-0.04, 0.04)))


def _movable(truth: Model) -> bool:
    """Whether friction takes less than 60 % of the supply's force on the smaller area: others are no rigs."""
    force = truth["piston.area_b"] * (truth["air.supply_pressure"] - truth["air.atmospheric_pressure"])
    return truth["lugre_friction.static_friction"] < FRICTION * force


def _integrable(truth: Model) -> bool:
    """Whether steps of 0.1 ms suffice for it: a bristle may be drawn too stiff."""
    try:
        truth.simulate(np.tile(np.repeat([2.0, -2.0], 100), 10), truth.state(), sample_time=2e-3)
    except NumericalError:
        return False
    return True


def plugs(model: Model, seeds: range) -> None:
    """How often the wiring is found."""
    found, spent, wrong = 0, [], []
    for seed in seeds:
        random = np.random.default_rng(seed)
        for words in COMBINATIONS:
            unit = ["Pa", *PRESSURE_UNITS][int(random.integers(0, 6))]
            said = (*words, *(() if unit == "Pa" else (unit,)), *(("mm",) if random.random() < 0.5 else ()))
            sensors = tuple(word for word in said if word in ("gauge", unit))
            begin = time.perf_counter()
            try:
                wired = Commissioning(model, rig_of(model, seed, said).perform, sensors=sensors).wiring()
                right = set(wired.words) == set(said)
            except PneumoError as error:
                wired, right = error, False
            spent.append(time.perf_counter() - begin)
            found += right
            wrong += [] if right else [f"  rig {seed}, {', '.join(said)}: {getattr(wired, 'words', wired)}"]
    print(f"wiring found: {found} of {len(spent)}, {np.median(spent):.1f} s each (median), worst {max(spent):.1f} s")
    print("\n".join(wrong[:10]))


def limits(model: Model, seeds: range, make: Callable[[Model, int], SimulatedRig]) -> None:
    """How often a limit is reached once the wiring is known."""
    refused = 0
    farthest: dict[str, dict[int, float]] = {"0": {}, "1 and 2": {}}  # by stage and seed
    for seed in seeds:
        rig = make(model, seed)
        job = Commissioning(model, rig.perform, sensors=())
        for stage, work in (("0", job.wiring), ("1 and 2", job.basics)):
            rig.farthest = 0.0
            try:
                work()
            except PneumoError:
                refused += 1
                break
            finally:
                farthest[stage][seed] = rig.farthest / (0.5 * model["piston.stroke"])
    for stage, ways in farthest.items():
        reached = [seed for seed, one in ways.items() if one >= 1.0]
        print(
            f"stages {stage}: end of the stroke reached on {len(reached)} of {len(ways)} rigs; "
            f"farthest from mid stroke {100.0 * max(ways.values()):.1f} % of half the stroke"
            + "".join(f"; rig {seed}" for seed in reached)
        )
    print(f"given up on {refused}")


def rigs(model: Model, seeds: range, make: Callable[[Model, int], SimulatedRig] = rig_of) -> None:
    """Whole commissionings: predicted and achieved deviations, coverage, and the constant voltages beside them."""
    ratios, inside, narrower, over_all, spent, moved = [], [], [], [], [], []
    each: dict[str, list[float]] = {}
    for seed in seeds:
        rig = make(model, seed)
        begin = time.perf_counter()
        try:
            job = Commissioning(model, rig.perform, sensors=(), minutes=MINUTES)
            found = job.run()
        except PneumoError as error:
            print(f"  rig {seed}: {error}")
            continue
        spent.append(time.perf_counter() - begin)
        moved.append(found.seconds)
        ratios += [move.ratio for move in found.moves if move.predicted]
        own = {
            name: one.low <= rig.truth[name] <= one.high
            for name, one in found.knowledge.estimates.items()
            if one.determined
        }
        inside += own.values()
        missed = [name for name, held in own.items() if not held]
        usual, seconds = constant_voltages(model, rig)
        beside = "the rig stopped the 16 constant voltages"
        if usual is not None:
            half = {name: 0.5 * default_prior(model, name) for name in usual}
            names = [name for name in usual if min(usual[name], job.known.deviations[name]) < half[name]]
            for name in names:
                each.setdefault(name, []).append(float(np.log(usual[name] / job.known.deviations[name])))
            over_all.append(np.exp(np.mean([np.log(usual[name] / job.known.deviations[name]) for name in usual])))
            narrower.append(np.exp(np.mean([each[name][-1] for name in names])))
            beside = f"16 constant voltages take {seconds:.0f} s and leave deviations {narrower[-1]:.1f} times as wide"
        told = np.median([move.ratio for move in found.moves if move.predicted] or [np.nan])
        print(
            f"  rig {seed}: {found.seconds:.0f} s of moves, {spent[-1]:.0f} s of computing, deviations {told:.2f} "
            f"times the predicted ones; truth inside {sum(own.values())} of {len(own)}; {beside}"
        )
        for name in missed:
            one, true = found.knowledge.estimates[name], rig.truth[name]
            print(
                f"    outside: {name} {one.value:.4g}, truth {true:.4g}, {(one.value - true) / one.std:+.1f} deviations"
            )
        sys.stdout.flush()
    if not spent:
        return
    low, middle, high = np.quantile(ratios, [0.05, 0.5, 0.95])
    print(f"achieved over predicted deviations: median {middle:.2f}, 90 % of moves {low:.2f} to {high:.2f}")
    print(f"truth inside the 95 % interval: {sum(inside)} of {len(inside)} determined parameters")
    if narrower:
        print(
            f"deviations of the 16 constant voltages over those here: median {np.median(over_all):.1f} over all "
            f"parameters, {np.median(narrower):.1f} over those that one of both determines, of which"
        )
        for name, logs in sorted(each.items(), key=lambda item: np.median(item[1])):
            print(f"    {name:36s} {np.exp(np.median(logs)):6.2f}")
    print(f"moves {np.median(moved):.0f} s, computing {np.median(spent):.0f} s (medians)")


def price(model: Model, seeds: range) -> None:
    """Minutes of moves until the other parameters are as narrow without the valve's three numbers as with them."""
    sure = with_known_valve(model)
    paid = []
    for seed in seeds:
        courses = []
        for sheet in (sure, model):
            rig, course = rig_of(sure, seed), []
            job = Commissioning(sheet, rig.perform, sensors=(), minutes=MINUTES)
            job.tell = lambda _, job=job, course=course: course.append(_narrow(job))
            job.run()
            courses.append([one for one in course if one[0] > 0.0])
        known, usual = courses
        for minutes, narrow in known:
            after = next((m for m, n in usual if n <= narrow), np.inf)
            paid.append((seed, minutes, after))
        shown = ", ".join(f"{m:.1f} -> {a:.1f}" for s, m, a in dict.fromkeys(paid) if s == seed)
        print(f"  rig {seed}: minutes with the valve known -> without: {shown}", flush=True)
    cost = [after - minutes for _, minutes, after in paid]
    print(f"price of the valve's three numbers: {np.median(cost):.1f} minutes (median over rigs and moves)")


def _narrow(job: Commissioning) -> tuple[float, float]:
    """Minutes of moves so far, and the mean log of the deviations over those of the data sheet, less the valve's."""
    names = [name for name in job.known.known.names if not name.startswith(UNSTATED)]
    logs = [np.log(job.known.deviations[name] / default_prior(job.model, name)) for name in names]
    return sum(move.seconds for move in job.moves) / 60.0 if logs else 0.0, float(np.mean(logs)) if logs else 0.0


def with_known_valve(model: Model) -> Model:
    """The machine file, sure of the three numbers of its valve."""
    return model.with_uncertainty({n: SURE if n.startswith(UNSTATED) else std for n, std in model.uncertainty.items()})


def constant_voltages(model: Model, rig: SimulatedRig) -> tuple[dict[str, float] | None, float]:
    """Deviations after the 16 constant voltages, None where the rig stopped them, and their seconds."""
    programme = make_programme("constant-voltage", model)
    programme = safe(programme, [rig.truth]) or programme
    done = replace(rig, seed=rig.seed + 1000, position=0.0).perform(programme, (), "constant")
    if not done.complete:
        return None, done.seconds
    try:
        return knowledge(model, [as_run(one, model, ()) for one in done.recordings]).deviations, done.seconds
    except PneumoError:
        return None, done.seconds


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rigs", type=int, default=4)
    parser.add_argument("--plugs", type=int, default=2)
    parser.add_argument("--limits", type=int, default=10)
    parser.add_argument("--second", type=int, default=1)
    parser.add_argument("--price", type=int, default=0)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--figures", action="store_true", help="rigs within the intervals of the sources' figures")
    parser.add_argument("--known-valve", action="store_true", help="dead zone and linearity are those of the file")
    options = parser.parse_args()
    model, first, make = data_sheet(), options.first_seed, rig_of_figures if options.figures else rig_of
    if options.known_valve:
        model = with_known_valve(model)
    if options.plugs:
        plugs(model, range(first, first + options.plugs))
    if options.limits:
        limits(model, range(first, first + options.limits), make)
    if options.rigs:
        rigs(model, range(first, first + options.rigs), make)
    if options.price:
        price(model, range(first, first + options.price))
    if options.second:
        from second_rig import file_of, second_rig

        print("second simulator:")
        rigs(file_of(), range(first, first + options.second), lambda _, seed: second_rig(seed))


if __name__ == "__main__":
    main()
