"""Exported machines against the kernel: time and states over 10 s of voltage steps into the end stops.

The kernel, the C file (-O2) and the FMU (FMI 2.0, the flags of `pneumo export`) hold 25 voltages for 0.4 s each, in
steps of 100 us: 25 calls from Python, so that calls take no time. Then the same as 10,000 communication steps of 1 ms.
Repetitions alternate, the table shows medians of processor time.

    python benchmarks/bench_export.py [--repetitions 11]
"""

import argparse
import ctypes
import io
import statistics
import subprocess
import tempfile
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from pneumo_ros.export import Exported, c_files, fmu_archive
from pneumo_ros.export.building import binary_path, compiler
from pneumo_ros.plant import Library, Model, Stepper, load_model

STEP, SAMPLE, HOLD, LEVELS = 1e-4, 1e-3, 0.4, 25
VOLTAGE = np.random.default_rng(2).choice([-6.0, -3.0, -1.2, 0.0, 1.2, 3.0, 6.0], LEVELS)
MORE = ("viscous_friction", "line_delay", "choked_flow", "cushioning", "position_sensor_delay")
Run = Callable[[np.ndarray, float], np.ndarray]


def machines() -> dict[str, Model]:
    """From few effects to all."""
    axis = load_model("axis")
    others = [name for name in Library().names() if name not in axis.effects]
    return {"axis": axis, "and five more": axis.with_effects([*axis.effects, *MORE]),
            "every effect": axis.with_effects([*axis.effects, *others])}  # fmt: skip


def address(array: np.ndarray) -> ctypes.c_void_p:
    """For a C function."""
    return array.ctypes.data_as(ctypes.c_void_p)


def by_kernel(model: Model) -> Run:
    """The kernel, all voltages in one call where they are long, sample by sample where they are short."""

    def run(voltage: np.ndarray, hold: float) -> np.ndarray:
        held = np.zeros((len(voltage), len(model.inputs)))
        held[:, model.inputs.index("U")] = voltage
        if hold > SAMPLE:
            return model.simulate(held, model.state(), sample_time=hold, step=STEP)[-1]
        stepper = Stepper(model, model.state(), sample_time=hold, step=STEP)
        for levels in held:
            stepper.advance(*levels)
        return stepper.state.copy()

    return run


def by_c(model: Model, folder: Path) -> Run:
    """The exported C file."""
    machine = Exported(model)
    header, source = c_files(machine, "machine.h")
    (folder / "machine.h").write_text(header, encoding="utf-8")
    (folder / "machine.c").write_text(source, encoding="utf-8")
    library = folder / f"machine_{len(model.effects)}.so"
    command = [*compiler(), "-std=c99", "-O2", "-shared", "-fPIC", "machine.c", "-o", library.name, "-lm"]
    subprocess.run(command, cwd=folder, check=True)
    advance, q = ctypes.CDLL(str(library))[f"{machine.prefix}_advance"], model.values
    advance.restype = None

    def run(voltage: np.ndarray, hold: float) -> np.ndarray:
        x, u, count = (
            np.concatenate([[0.0], model.state()]),
            np.zeros(len(machine.inputs)),
            ctypes.c_ulong(round(hold / STEP)),
        )
        given, h = (address(x), address(u), address(q)), ctypes.c_double(STEP)
        for level in voltage:
            u[0] = level
            advance(*given, h, count)
        return x[1:]

    return run


def by_fmu(model: Model, folder: Path) -> Run:
    """The FMU in co-simulation, without a simulator in between."""
    machine = Exported(model)
    with zipfile.ZipFile(io.BytesIO(fmu_archive(machine, 2))) as archive:
        path = archive.extract(binary_path(machine.prefix, 2), folder / f"fmu_{len(model.effects)}")
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    fmu, token = ctypes.CDLL(path), root.get("guid", "").encode()
    fmu.fmi2Instantiate.restype = ctypes.c_void_p
    references = {v.get("name", ""): int(v.get("valueReference", "")) for v in root.iter("ScalarVariable")}
    callbacks = (ctypes.c_void_p * 5)()
    states = np.array([references[name] for name in model.states], dtype=np.uint32)
    number, size = ctypes.c_double, ctypes.c_size_t

    def run(voltage: np.ndarray, hold: float) -> np.ndarray:
        unit = ctypes.c_void_p(fmu.fmi2Instantiate(b"axis", 1, token, b"", callbacks, 0, 0))
        fmu.fmi2EnterInitializationMode(unit)
        assert fmu.fmi2ExitInitializationMode(unit) == 0
        U, u, one = np.array([references["U"]], dtype=np.uint32), np.zeros(1), size(1)
        where, what, length = address(U), address(u), number(hold)
        for k, level in enumerate(voltage):
            u[0] = level
            fmu.fmi2SetReal(unit, where, one, what)
            assert fmu.fmi2DoStep(unit, number(k * hold), length, 0) == 0
        x = np.empty(len(states))
        fmu.fmi2GetReal(unit, address(states), size(len(x)), address(x))
        fmu.fmi2FreeInstance(unit)
        return x

    return run


def clocked(run: Run, voltage: np.ndarray, hold: float) -> float:
    """Processor time of one run [s]."""
    begin = time.process_time()
    run(voltage, hold)
    return time.process_time() - begin


def table(repetitions: int, voltage: np.ndarray, hold: float) -> None:
    """Times and ratios of all machines, one row each."""
    print(f"\n{len(voltage)} communication steps of {hold:g} s")
    print(f"  {'machine':16s} {'effects':>7s} {'kernel':>9s} {'C / kernel':>11s} {'FMU / kernel':>13s} {'apart':>9s}")
    for name, model in machines().items():
        with tempfile.TemporaryDirectory() as folder:
            kernel, *others = by_kernel(model), by_c(model, Path(folder)), by_fmu(model, Path(folder))
            wanted = kernel(voltage, hold)
            scale = np.maximum(np.abs(wanted), np.finfo(float).tiny)  # some states of some effects stay 0
            apart = max((np.abs(run(voltage, hold) - wanted) / scale).max() for run in others)
            assert apart < 1e-9, f"{name}: states differ by {apart:.1e}"
            rows = [[clocked(run, voltage, hold) for run in (kernel, *others)] for _ in range(repetitions)]
        ours = statistics.median(row[0] for row in rows)
        in_c, in_fmu = (statistics.median(row[i] / row[0] for row in rows) for i in (1, 2))
        print(f"  {name:16s} {len(model.effects):7d} {1e3 * ours:6.1f} ms {in_c:11.2f} {in_fmu:13.2f} {apart:9.1e}")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repetitions", type=int, default=11, help="alternating repetitions of each timing")
    repetitions = parser.parse_args().repetitions
    print("Exported machines against the kernel, 10 s (target of the FMU: at most 1.20)")
    table(repetitions, VOLTAGE, HOLD)
    table(repetitions, np.repeat(VOLTAGE, round(HOLD / SAMPLE)), SAMPLE)


if __name__ == "__main__":
    main()
