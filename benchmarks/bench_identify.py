"""Identification on the paper's machine with sensor noise: errors, and how often the intervals contain the true value.

Fourteen constant-voltage runs of 8 s at 1 kHz (10 um, 300 Pa), repeated over noise seeds. Prints, per parameter, the
largest error, the share of seeds whose 95 % interval contains the true value, and how often it was undetermined;
then the time of one identification.

    python benchmarks/bench_identify.py [--seeds 40]
"""

import argparse
import statistics
import time

import numpy as np

from pneumo_ros.identify.campaign import FRICTION, Identification, identify
from pneumo_ros.identify.flow import COEFFICIENTS, LIMITS
from pneumo_ros.identify.presliding import STIFFNESS
from pneumo_ros.plant import Model, load_model
from pneumo_ros.runs.run import PARTS, Run

VOLTAGES = (0.80, 0.83, 0.90, 1.0, 1.3, 2.0, 7.0)
SECONDS, SAMPLE_TIME = 8.0, 1e-3
POSITION_NOISE, PRESSURE_NOISE = 10e-6, 300.0
CLOSED = 0.1  # s before the valve opens


def campaign(model: Model) -> list[tuple[str, np.ndarray, np.ndarray]]:
    """Noise-free runs: name, states (n, states) at every sample, voltage (n - 1,)."""
    runs = []
    for voltage in (*VOLTAGES, *(-v for v in VOLTAGES)):
        held = np.full(round(SECONDS / SAMPLE_TIME), voltage)
        held[: round(CLOSED / SAMPLE_TIME)] = 0.0
        start = model.state(y=-0.9 if voltage > 0 else 0.9, p_a=1.2e5, p_b=1.6e5)
        states = np.vstack([start, model.simulate(held, start, sample_time=SAMPLE_TIME)])
        runs.append((f"constant_{voltage:+.2f}V", states, held))
    return runs


def measured(runs: list[tuple[str, np.ndarray, np.ndarray]], seed: int) -> list[Run]:
    """The same runs with sensor noise."""
    rng = np.random.default_rng(seed)
    return [
        Run(
            name, SAMPLE_TIME, states[:, 0] + POSITION_NOISE * rng.standard_normal(len(states)),
            states[:, 2] + PRESSURE_NOISE * rng.standard_normal(len(states)),
            states[:, 3] + PRESSURE_NOISE * rng.standard_normal(len(states)),
            np.repeat(held, PARTS), np.ones(len(states), dtype=bool), False,
        )
        for name, states, held in runs
    ]  # fmt: skip


def started_wrong(model: Model) -> Model:
    """The machine file a user has before identification: friction off by 10 to 30 %."""
    factor = {"static_friction": 0.85, "coulomb_friction": 1.1, "stribeck_velocity": 1.3}
    wrong = {f"lugre_friction.{key}": model[f"lugre_friction.{key}"] * f for key, f in factor.items()}
    return model.with_parameters({**wrong, "quadratic_drag.coefficient": 1.2 * model["quadratic_drag.coefficient"]})


def table(truth: Model, results: list[Identification]) -> str:
    """One row per parameter."""
    lines = [f"{'parameter':36s} {'truth':>12s} {'worst error':>12s} {'covered':>9s} {'undetermined':>13s}"]
    every: list[bool] = []
    for name in (*(n for n in FRICTION if n in truth.parameters), *COEFFICIENTS, *LIMITS, STIFFNESS):
        found = [r.parameters[name] for r in results]
        known = [f for f in found if f.interval is not None]
        worst = max((abs(f.value / truth[name] - 1.0) for f in known), default=float("nan"))
        held = [f.interval[0] <= truth[name] <= f.interval[1] for f in known if f.interval]
        every += held
        cover = f"{100 * sum(held) / len(held):.0f} %" if held else "-"
        lines.append(f"{name:36s} {truth[name]:12.5g} {100 * worst:10.3f} % {cover:>9s} {len(found) - len(known):13d}")
    lines.append(f"{'all intervals':36s} {'':12s} {'':12s} {100 * sum(every) / max(len(every), 1):8.1f} %")
    return "\n".join(lines)


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, default=40)
    seeds = parser.parse_args().seeds
    truth = load_model("paper")
    clean, start = campaign(truth), started_wrong(truth)
    results, times = [], []
    for seed in range(seeds):
        runs = measured(clean, seed)
        begun = time.perf_counter()
        results.append(identify(start, runs))
        times.append(time.perf_counter() - begun)
    print(f"{len(clean)} runs of {SECONDS:g} s, {seeds} noise seeds, 95 % intervals")
    print(table(truth, results))
    print(f"identify, median of {seeds}: {statistics.median(times):.2f} s")


if __name__ == "__main__":
    main()
