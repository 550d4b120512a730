"""The plant's kernel against a hand-written C loop, and the time to compile and to start it.

One step of 100 us of the base machine: ours, and reference_axis.c (classical Runge-Kutta, gcc -O3 -march=native,
compiled here). Both follow the same voltages; before timing, both are compared with a run in steps of 10 us.
Repetitions alternate, the table shows medians of processor time. At rest the C loop skips exp and sin, ours does not.
Then a batch of 64 machines on one core, 75 parameter vectors with all effects along one measured motion, and fresh
processes.

    python benchmarks/bench_kernel.py [--repetitions 21] [--starts 5]
"""

import argparse
import ctypes
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from pneumo_ros.plant import Library, Model, load_model

HERE = Path(__file__).parent
SAMPLE, STRIDE, STEP, SETS = 1e-3, 10, 1e-4, 64
VECTORS, SINGLES = 75, 16  # parameter vectors in parallel, and how many of them also run one after another
FLAGS = ["-O3", "-march=native", "-shared", "-fPIC"]


def workloads() -> dict[str, np.ndarray]:
    """Voltages of 10 s at 1 kHz, by name."""
    random = np.random.default_rng(2)
    levels = random.choice([-6.0, -3.0, -1.2, 0.0, 0.0, 1.2, 3.0, 6.0], 25)
    t = np.arange(10000) * SAMPLE
    return {
        "steps, stops, reversals": np.repeat(levels, 400),
        "slow sine": 5.0 * np.sin(2.0 * np.pi * 0.3 * t),
        "steady sliding": np.full(10000, 2.0),
        "at rest": np.zeros(10000),
    }


def compile_loop(folder: str) -> Callable[[np.ndarray, np.ndarray, np.ndarray, int, float], np.ndarray]:
    """The C loop as a function of (state, parameters, voltage, stride, step), returning the states."""
    library = Path(folder) / "reference_axis.so"
    try:
        subprocess.run(["gcc", *FLAGS, "-o", str(library), str(HERE / "reference_axis.c"), "-lm"], check=True)
    except FileNotFoundError:
        sys.exit("this benchmark compares with C and needs gcc; type: sudo apt install gcc")
    loop, array = ctypes.CDLL(str(library)).run, np.ctypeslib.ndpointer(np.float64, flags="C")
    loop.argtypes = [array, array, array, ctypes.c_long, ctypes.c_long, ctypes.c_double, array]
    loop.restype = None

    def run(start: np.ndarray, q: np.ndarray, voltage: np.ndarray, stride: int, h: float) -> np.ndarray:
        x, out = start.copy(), np.empty((len(voltage), len(start)))
        loop(x, q, voltage, len(voltage), stride, h, out)
        return out

    return run


def start_of(model: Model) -> np.ndarray:
    """Initial state of every run: the forces on the piston nearly balance."""
    return model.state(y=-0.9, p_a=3e5, p_b=3.73e5)


def clocked(function: Callable[[], object]) -> float:
    """Processor time of one call [s]."""
    begin = time.process_time()
    function()
    return time.process_time() - begin


def alternate(ours: Callable[[], object], theirs: Callable[[], object], repetitions: int) -> tuple[float, float, float]:
    """Medians of both [s], and of the ratio of neighbours, ours over theirs."""
    pairs = [(clocked(ours), clocked(theirs)) for _ in range(repetitions + 2)][2:]
    mine, other = zip(*pairs, strict=True)
    return statistics.median(mine), statistics.median(other), statistics.median(a / b for a, b in pairs)


def our_loop(model: Model, voltage: np.ndarray) -> Callable[[], None]:
    """Our kernel over these voltages, from the start, as a function without arguments."""
    kernel, x, q, out = model.kernel.run, start_of(model), model.values, np.empty((len(voltage), len(model.states)))
    return lambda: kernel(x.copy(), q, voltage.reshape(-1, 1), 0.0, STEP, STRIDE, 1, out)


def single(model: Model, loop: Callable[..., np.ndarray], repetitions: int) -> None:
    """Table of one machine: errors against short steps, time per step, ratio."""
    print(
        f"{'one machine':26s} {'error ours':>12s} {'error C':>12s} {'ours':>10s} {'C':>10s}   "
        "ours / C (target: at most 1)"
    )
    x = start_of(model)
    for name, voltage in workloads().items():
        run_c = partial(loop, x, model.values, voltage, STRIDE, STEP)
        exact = model.simulate(voltage, x, step=1e-5)
        errors = [np.abs(run - exact)[:, 0].max() * 1e6 for run in (model.simulate(voltage, x), run_c())]
        assert max(errors) < 100.0, f"{name}: the two do not compute the same motion, errors {errors} um"
        mine, other, ratio = alternate(our_loop(model, voltage), run_c, repetitions)
        a_step = 1e9 / (len(voltage) * STRIDE)
        print(
            f"  {name:24s} {errors[0]:9.2f} um {errors[1]:9.2f} um {mine * a_step:7.1f} ns {other * a_step:7.1f} ns   "
            f"{ratio:8.2f}"
        )


def batch(model: Model, loop: Callable[..., np.ndarray], repetitions: int) -> None:
    """64 machines of different mass and friction on one core: lanes against one C run after another."""
    random, names = np.random.default_rng(3), list(model.parameters)
    q, x = np.tile(model.values, (SETS, 1)), np.tile(start_of(model), (SETS, 1))
    for name in ("piston.mass", "lugre_friction.coulomb_friction", "lugre_friction.static_friction"):
        q[:, names.index(name)] *= random.uniform(0.9, 1.1, SETS)
    voltage = workloads()["steps, stops, reversals"][:2000]
    lanes = model.simulate_lanes(voltage, x, q, threads=1)
    apart = max(np.abs(lanes[i, :, 0] - loop(x[i], q[i], voltage, STRIDE, STEP)[:, 0]).max() for i in range(SETS))
    assert apart < 1e-4, f"the two do not compute the same motions: {apart} m apart"
    mine, other, ratio = alternate(
        lambda: model.simulate_lanes(voltage, x, q, threads=1),
        lambda: [loop(x[i], q[i], voltage, STRIDE, STEP) for i in range(SETS)],
        repetitions,
    )
    steps = SETS * len(voltage) * STRIDE
    print(
        f"{SETS} machines, one core: ours {mine / steps * 1e9:.1f} ns, C {other / steps * 1e9:.1f} ns per step; "
        f"throughput ours / C {1.0 / ratio:.2f}   (target: at least 3.00)"
    )


def following(axis: Model, repetitions: int) -> None:
    """All effects driven along one motion of 2 s, by 75 parameter vectors: lanes against one after another."""
    effects = list(axis.effects)
    for name in Library().names():
        larger = [*effects, *([] if name in effects else [name])]
        if axis.with_effects(larger).inputs == axis.inputs:  # it reads no measured signal
            effects = larger
    model = axis.with_effects(effects)
    voltage, how = workloads()["steps, stops, reversals"][:4000], {"parts": 2, "step": 5e-4}
    measured, rest = axis.simulate(voltage, start_of(axis), **how)[:, :4], model.state()[4:]
    q = model.values * np.random.default_rng(4).uniform(0.98, 1.02, (VECTORS, len(model.parameters)))
    lone, kernel = [dict(zip(model.parameters, row, strict=True)) for row in q[:SINGLES]], model.kernel
    models = [Model(model.composition, values, model.name, model.library) for values in lone]
    wanted = {"states": (), "columns": ("v", "p_a", "p_b"), **how}
    lanes = model.follow_lanes(measured, voltage, rest, q, **wanted)[1]
    for i, single in enumerate(models):
        vars(single)["kernel"] = kernel  # loaded once
        assert lanes[i].tobytes() == single.follow(measured, voltage, rest, **how)[1][:, 1:4].tobytes()
    many, one, _ = alternate(
        lambda: model.follow_lanes(measured, voltage, rest, q, **wanted),
        lambda: [single.follow(measured, voltage, rest, **how) for single in models],
        repetitions,
    )
    a_step = 1e9 / (len(voltage) - 2)
    print(
        f"{len(model.effects)} effects, {len(model.states)} states along a motion: follow_lanes "
        f"{many / VECTORS * a_step:.0f} ns, follow {one / SINGLES * a_step:.0f} ns per step and vector; throughput "
        f"lanes / single {one / SINGLES / (many / VECTORS):.2f}   (target: at least 3.00)"
    )


FIRST_STEP = """
import time
from pneumo_ros.plant import Stepper, load_model
import pneumo_ros.plant.jit
imported = time.process_time()
model = load_model("axis")
Stepper(model, model.state()).advance(1.0)
print(time.monotonic(), imported, time.process_time())
"""


def fresh_process(kernels: str) -> tuple[float, float, float]:
    """A new interpreter up to its first step: wall time, processor time, processor time after the imports [s]."""
    begin = time.monotonic()
    environment = {**os.environ, "PNEUMO_KERNELS": kernels}
    done = subprocess.run(
        [sys.executable, "-c", FIRST_STEP], env=environment, capture_output=True, text=True, check=True
    )
    end, imported, total = map(float, done.stdout.split())
    return end - begin, total, total - imported


def starts(repetitions: int) -> None:
    """Cold (nothing compiled yet) and warm starts, each the median over fresh processes."""
    cold, warm = [], []
    for _ in range(repetitions):
        with tempfile.TemporaryDirectory() as kernels:
            cold.append(fresh_process(kernels))
            warm.append(fresh_process(kernels))
    _, total, compiling = (statistics.median(column) for column in zip(*cold, strict=True))
    print(f"cold: {compiling:.2f} s of processor time to compile (target: under 2.00), {total:.2f} s with all imports")
    wall, total, _ = (statistics.median(column) for column in zip(*warm, strict=True))
    print(
        f"warm: {wall:.2f} s from start of Python to first step (target: under 0.50), {total:.2f} s of processor time"
    )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repetitions", type=int, default=21, help="interleaved repetitions of each timing")
    parser.add_argument("--starts", type=int, default=5, help="fresh processes for cold and warm starts")
    options = parser.parse_args()
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}; the C loop: gcc {' '.join(FLAGS[:2])}")
    model = load_model("axis")
    with tempfile.TemporaryDirectory() as folder:
        loop = compile_loop(folder)
        single(model, loop, options.repetitions)
        batch(model, loop, max(5, options.repetitions // 3))
    following(model, max(5, options.repetitions // 3))
    starts(options.starts)


if __name__ == "__main__":
    main()
