"""The paper reproduced: its two tables, Fig. 4 and Fig. 6, on recordings of the second simulator as the bench.

    python -m benchmarks.paper [--pictures FOLDER] [--recordings FOLDER] [--seed 1]      or: make paper

The second simulator, test/rig, has the printed parameters and noisy sensors. It is driven by constant voltages, as in
the paper's section 6; the identification has to find Table 2 from a machine file whose friction is off by 10 to 30 %.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import pneumo_ros as pn
from benchmarks.paper import bench, models, pictures, tables


def as_printed(folder: Path, names: list[str]) -> dict[str, pn.IdentificationResult]:
    """Identifications by Eq. 2 as printed, which lacks the atmosphere's force on the rod."""
    chosen = {"advances alone (95 %)": [name for name in names if "_p" in name], "both directions (95 %)": names}
    return {
        label: pn.identify([folder / name for name in some], models.before("paper")) for label, some in chosen.items()
    }


def curves(model: pn.Model, recorded: pn.Recording) -> dict[str, pn.Recording]:
    """The simulated curves of Fig. 6, driven by the recorded voltage from the recorded start."""
    machines = {
        "(b) identified friction dynamics": model,
        "(c) without friction": models.without_friction(model),
        "(c') static map without bristles": models.without_bristles(model),
    }
    return {name: pn.simulate(machine, recorded) for name, machine in machines.items()}


def reproduce(folder: Path, names: list[str], seed: int, out: Path) -> str:
    """Record into `folder`, identify, simulate, draw into `out`; the tables as text."""
    bench.record_bench(folder, seed, names)
    first = pn.identify([folder / name for name in names], models.before("axis"))
    recorded = pn.read(folder / bench.ADVANCE)
    simulated = curves(first.model, recorded)
    speeds = {
        f"{'-' if '_m' in name else '+'}{int(name[-4:]) / 1e3:g} V": pn.read(folder / name) for name in names[-4:]
    }
    pairs = {label: (one, pn.simulate(first.model, one)) for label, one in speeds.items()}
    out.mkdir(parents=True, exist_ok=True)
    pictures.figure_4(first, pn.load_model("axis"), out / "paper_figure_4.png")
    pictures.figure_6(recorded, simulated, out / "paper_figure_6.png")
    parts = {
        "Table 1": tables.table_1(first),
        "Table 2": f"{tables.table_2(first)}\n{tables.equations_15_16(first.model)}",
        "Table 2 by Eq. 2 as printed": tables.as_printed(as_printed(folder, names)),
        "Steady motion at constant voltage": tables.steady_speeds(pairs),
        "Fig. 6, advance under 7 V": tables.figure_6(recorded, simulated),
    }
    return "\n\n".join(f"{title}\n{text}" for title, text in parts.items())


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pictures", type=Path, default=Path(".cache/paper"), help="where the pictures go")
    parser.add_argument("--recordings", type=Path, help="keep the recordings in this folder, which must be new")
    parser.add_argument("--seed", type=int, default=1, help="of the sensors' noise")
    wanted = parser.parse_args()
    if wanted.recordings and wanted.recordings.exists():
        parser.error(f"{wanted.recordings} exists; give another folder")
    with tempfile.TemporaryDirectory() as scratch:
        folder = wanted.recordings or Path(scratch)
        print(reproduce(folder, bench.staircase(), wanted.seed, wanted.pictures))
    print(f"Figures 4 and 6 are in {wanted.pictures}", file=sys.stderr)


if __name__ == "__main__":
    main()
