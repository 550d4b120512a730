"""Machines with on/off valves and with pressure regulators: identified from data sheets, and diagnosed.

Usage: python benchmarks/bench_valves.py [--kinds pulses regulators] [--seconds 15] [--diagnose [healthy viscous leak]]

A cylinder of 25/10 x 200 mm with a moving mass of 2 kg: two 3/2 valves with pulses of 50 Hz, or a regulator for each
chamber. The machine lies within the scatter of its data sheets (test/identify/jogging.py), with 38 and 28 N of friction
where they say 35 and 24 N; sensors at 1 kHz have noise of 5 um and 300 Pa. The piston is sent to and fro by a simple
controller. Identification prints how far each parameter is off; diagnosis which effects are added. Hidden are nothing,
a viscous friction of 90 N s/m, or a leak across the piston of 1e-10 kg/(s Pa). Times are of the processor.
"""

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "test"))

from identify.jogging import SHEETS, jogged, sheet, truth

from pneumo_ros.diagnose.diagnosis import diagnose
from pneumo_ros.identify.campaign import identify
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run

EVERY = {"steps": 0.4, "quick": 0.15, "slowly": 1.5}  # s between two goals
HIDDEN: dict[str, dict[str, float]] = {
    "healthy": {},
    "viscous": {"viscous_friction.coefficient": 90.0},
    "leak": {"cross_piston_leakage.conductance": 1e-10},
}


def with_hidden(model: Model, values: dict[str, float]) -> Model:
    """The machine with the hidden effects."""
    return model.with_effects([*model.effects, *(name.partition(".")[0] for name in values)], values)


def identified(kind: str, seconds: float) -> None:
    """Identify from the data sheet, and print each parameter beside the truth."""
    model, real = sheet(kind), truth(sheet(kind))
    runs = [jogged(real, name, seconds, every) for name, every in EVERY.items()]
    begun = time.process_time()
    found = identify(model, runs)
    print(f"\n{kind}: {found.segments} segments, {found.misfit:.2f} x noise, {time.process_time() - begun:.0f} s")
    for name, one in found.parameters.items():
        inside = "-" if one.interval is None else "inside" if one.interval[0] < real[name] < one.interval[1] else "out"
        off = 100.0 * (one.value / real[name] - 1.0)
        print(f"  {name:40s} {model[name]:10.4g} -> {one.value:10.5g}  {off:+7.2f} %  {inside}")


def diagnosed(kind: str, hidden: str, seconds: float) -> None:
    """Diagnose, and print what is added."""
    real = with_hidden(truth(sheet(kind)), HIDDEN[hidden])
    train: list[Run] = [jogged(real, name, seconds, every) for name, every in EVERY.items()]
    begun = time.process_time()
    found = diagnose(sheet(kind), train, [jogged(real, "held out", seconds, 0.4)])
    spent = time.process_time() - begun
    added = {k: v for k, v in found.model.parameters.items() if k not in sheet(kind).parameters}
    shown = ", ".join(f"{name} {value:.4g}" for name, value in added.items()) or "nothing"
    course = " -> ".join(f"{error:.3g}" for _, error in found.waterfall)
    print(f"{kind}, {hidden}: {found.verdict}; added: {shown}; held-out error {course}; {spent:.0f} s", flush=True)


def main() -> None:
    """Print both tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kinds", nargs="+", choices=list(SHEETS), default=list(SHEETS))
    parser.add_argument("--seconds", type=float, default=15.0, help="length of each of three runs")
    parser.add_argument("--diagnose", nargs="*", choices=list(HIDDEN), help="diagnose only; without names all three")
    options = parser.parse_args()
    for kind in options.kinds:
        if options.diagnose is None:
            identified(kind, options.seconds)
        for hidden in [] if options.diagnose is None else options.diagnose or list(HIDDEN):
            diagnosed(kind, hidden, options.seconds)


if __name__ == "__main__":
    main()
