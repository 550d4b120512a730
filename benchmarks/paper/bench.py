"""The bench of the paper, played by the second simulator under test/rig, which shares no code with the package.

Its machine has the figures of Tables 1 and 2, the atmosphere pushes on its rod, and its sensors are noisy.
"""

import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "test"))

from rig import bags, loop  # noqa: E402 - from the folder of the tests
from rig.case import Case, epoch, make_run  # noqa: E402 - as above
from rig.excitation import STAIRCASE, constant_name, run_rng  # noqa: E402 - as above
from rig.machine import SMOOTH, Machine  # noqa: E402 - as above
from rig.sensors import Run, position_noise, record  # noqa: E402 - as above

ADVANCE = "advance_7V"
VOLTS, SECONDS, CLOSED = 7.0, 12.5, 0.5  # of the advance; the valve opens after CLOSED [s]
WITHDRAWN = -0.99  # m, 10 mm from the end of the stroke
_PRESSURE = 1.2e5  # Pa, of chamber a at rest


def staircase(volts: tuple[float, ...] = STAIRCASE) -> list[str]:
    """The names of the constant-voltage runs, each level in both directions."""
    return [constant_name(sign * level) for level in volts for sign in (1.0, -1.0)]


def record_bench(folder: Path, seed: int, names: list[str]) -> None:
    """Record the runs `names`, and the advance of Fig. 6, as bags in `folder`; the seed draws the noise."""
    case = Case(Machine(), False, seed, {})
    for name in names:
        bags.write(folder / name, make_run(case, name), epoch(seed))
    bags.write(folder / ADVANCE, advance(case), epoch(seed))


def advance(case: Case) -> Run:
    """The withdrawn piston advances under a step of 7 V, to the other end of the stroke."""
    rng, samples = run_rng(case.seed, ADVANCE), round(SECONDS / loop.SAMPLE)
    voltage = np.where(np.arange(samples) * loop.SAMPLE < CLOSED, 0.0, VOLTS)
    noise = position_noise(rng, samples)
    rest = loop.run(case.machine, SMOOTH, loop.rest(case.machine, WITHDRAWN, _PRESSURE), np.zeros(1000))[0][-1]
    states, applied = loop.run(case.machine, SMOOTH, rest, voltage)
    return record(ADVANCE, case.machine, states, applied, noise, rng)
