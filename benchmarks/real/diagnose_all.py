"""Real machines, a row each: `python benchmarks/real/diagnose_all.py BAGS`, or PNEUMO_REAL_BAGS for BAGS.

BAGS holds a folder of recordings for each machine of table/cases.yaml, as `import_all.py` writes them, or as recorded.
Each machine is diagnosed; the table says what was found, the error of predictions of the recordings that were not
fitted, as the machine file gives it, refitted, and with what was found, and the rms of one simulation of a whole
recording from its first sample alone, beside what was published. A machine of your own is a folder, a machine file and
an entry of table/cases.yaml.
"""

import argparse
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from pneumo_ros.compare.wording import SIGNALS
from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.diagnose.outcome import Outcome
from pneumo_ros.plant import Model, load_model
from pneumo_ros.reading.read import read_runs
from pneumo_ros.runs.inputs import measuring
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.refit import refit
from pneumo_ros.shooting.windows import free_run
from pneumo_ros.units import writing

HERE = Path(__file__).parent


def recordings(folder: Path, names: list[str], model: Model) -> list[Run]:
    """The runs of the recordings whose names begin so; empty where one is missing."""
    found = [[path for path in sorted(folder.iterdir()) if path.name.startswith(name)] for name in names]
    return read_runs([str(path) for some in found for path in some], model).runs if all(found) else []


def machine(name: str) -> Model:
    """The machine file beside this file, or the shipped one of that name."""
    own = HERE / "machines" / f"{name}.yaml"
    return load_model(str(own) if own.exists() else name)


def row(name: str, case: dict[str, Any], folder: Path) -> str:
    """Several lines on one machine."""
    model = machine(name)
    train, held = (recordings(folder, case[role], model) for role in ("fit", "judge"))
    if not train or not held:
        return f"{name}: not all of its recordings are in {folder}"
    model, begin = measuring(model, [*train, *held]), time.process_time()
    found = diagnose(model, train, held, horizon=case["horizon"])
    seconds = time.process_time() - begin
    course = " -> ".join(f"{error:.3g}" for _, error in found.waterfall)
    return "\n".join(
        [
            f"{name}: {len(train)} recordings fitted, {len(held)} held out, {seconds:.0f} s of processor time",
            f"  found      {added(found)}; verdict {found.verdict}",
            f"  predicted  over {case['horizon']:g} s, noise floors: {course}",
            f"  simulated  from the first sample alone: {alone(found)}",
            f"  mean size  of that error over all of them: {size_of_all(found, held)}",
            *(refitted(found, train, held, case["segment"]) if "segment" in case else ()),
            f"  published  {case['published']}",
        ]
    )


def added(found: Outcome) -> str:
    """The effects added, with their sizes and deviations."""
    each = [
        f"{one.effect} ({', '.join(f'{k} {v.value:.3g} +- {v.std:.1g} {v.unit}' for k, v in one.parameters.items())})"
        for one in found.added
    ]
    return ", ".join(each) or "nothing"


def alone(found: Outcome) -> str:
    """By held-out recording and signal, the rms of one whole simulation before and after."""
    parts = []
    for before, after in zip(found.before.runs, found.after.runs, strict=True):
        for name, error in after.free.items():
            words, unit, factor = SIGNALS[name]
            parts.append(f"{after.name} {words} {factor * before.free[name]:.3g} -> {factor * error:.3g} {unit}")
    return "; ".join(parts)


def refitted(found: Outcome, train: list[Run], held: list[Run], segment: float) -> list[str]:
    """What was found, fitted once more to segments of `segment` [s]; the rms of whole simulations with it."""
    added = {one.effect for one in found.added}
    wide = {name: found.model.usual_size(name) for name in found.model.parameters if name.partition(".")[0] in added}
    fitted = refit(found.model, train, priors=wide, segment=segment)
    sizes = ", ".join(f"{name} {one.value:.3g} +- {one.std:.1g}" for name, one in fitted.estimates.items())
    parts = []
    for run in held:
        for name, error in free_run(fitted.model, run).errors.items():
            words, unit, factor = SIGNALS[name]
            parts.append(f"{run.name} {words} {factor * np.sqrt(np.nanmean(error**2)):.3g} {unit}")
    return [f"  refitted   over {segment:g} s: {sizes}", f"  simulated  with that: {'; '.join(parts)}"]


def size_of_all(found: Outcome, held: list[Run]) -> str:
    """By signal, the mean absolute error of whole simulations of all recordings, before and after."""
    whole = [[free_run(model, run).errors for run in held] for model in (found.base, found.model)]
    parts = []
    for name in whole[0][0]:
        words, unit, factor = SIGNALS[name]
        before, after = (factor * np.mean([np.nanmean(np.abs(one[name])) for one in every]) for every in whole)
        parts.append(f"{words} {before:.3g} -> {after:.3g} {unit}")
    return "; ".join(parts)


def folder_of(name: str, case: dict[str, Any]) -> str:
    """The folder of a case's recordings: of its name, or of another that several cases share."""
    return str(case.get("recordings", name))


def main(bags: Path, only: list[str]) -> int:
    """Print all rows, or `only` those; 2 where a machine's recordings are missing."""
    cases = yaml.safe_load((HERE / "table" / "cases.yaml").read_text(encoding="utf-8"))
    cases = {name: case for name, case in cases.items() if not only or name in only}
    there = {name: case for name, case in cases.items() if (bags / folder_of(name, case)).is_dir()}
    for name, case in there.items():
        with writing(machine(name).coordinate):
            print(row(name, case, bags / folder_of(name, case)), flush=True)
    absent = ", ".join(name for name in cases if name not in there)
    if absent:
        print(f"no folder in {bags} for: {absent}")
    return 0 if there else 2


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", default=[], help="names of machines")
    parser.add_argument("bags", nargs="?", default=os.environ.get("PNEUMO_REAL_BAGS"), help="default: PNEUMO_REAL_BAGS")
    options = parser.parse_args()
    if options.bags is None:
        parser.error("name the folder of the recordings, or set PNEUMO_REAL_BAGS")
    sys.exit(main(Path(options.bags), options.only))
