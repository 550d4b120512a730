"""Whether the drive that was measured moves the piston: or a test machine did; and whether the velocity fits.

What moves a piston does work against friction. Sealed gas that is compressed and expands gives back what it took, and
a force that does not move the piston predicts no motion.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.guess import first_guess
from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model
from pneumo_ros.records import Recording
from pneumo_ros.records.corrections import LENGTH_UNITS
from pneumo_ros.runs.run import PARTS, Run
from pneumo_ros.units import shown

Array = NDArray[np.float64]

_WORK = 0.1  # of all work, done and taken: less is done by gas that another machine compresses
_SEALED = 0.9  # correlation of position and logarithm of pressure in a sealed chamber
_FAR = 2.0  # times the travel of the run: farther a force that moves the piston does not lead
_WINDOW, _MOST = 1.0, 20  # s and number of the windows that are predicted
_FOLLOWS, _UNIT = 0.7, 0.1  # correlation with the derivative of position; relative distance from a unit's factor
_STEADY = 1e-3  # m/s: below it the piston rests, and its motion decides nothing


def check_sealed(run: Run) -> None:
    """Raises DataError where both pressures, which are said to drive the piston, follow its position as sealed gas."""
    if run.pressure_a is None or run.pressure_b is None or np.ptp(run.position) == 0.0:
        return
    force = run.held - run.held.mean()
    work = force * np.diff(run.position)
    low = min(float(run.pressure_a.min()), float(run.pressure_b.min()))
    if low <= 0.0 or work.sum() > _WORK * np.abs(work).sum():
        return
    if min(np.ptp(run.pressure_a), np.ptp(run.pressure_b)) == 0.0:
        return
    with_a, with_b = (np.corrcoef(np.log(p), run.position)[0, 1] for p in (run.pressure_a, run.pressure_b))
    if with_a < -_SEALED and with_b > _SEALED:
        raise DataError(
            f"{run.name}: the motion was imposed, it seems: both pressures follow the position as those of sealed "
            f"chambers do (correlation {with_a:.2f} and {with_b:.2f}), so that they do not move the piston. Type "
            "--imposed, and name imposed_motion among the effects of the machine file, and no valve"
        )


def imposed_note(model: Model, run: Run) -> Iterator[str]:
    """A note where the measured force leads the model's piston far away from the measured motion."""
    if run.imposed or run.by_pressures or model.self_driven or not model.force_driven:
        return
    samples = min(round(_WINDOW / run.sample_time), len(run) - 1)
    starts = np.arange(0, len(run) - samples, samples)
    starts = starts[:: max(len(starts) // _MOST, 1)]
    states = model.simulate_lanes(
        run.inputs(model.inputs), first_guess(model, run, starts), samples=samples, first=starts * PARTS,
        sample_time=run.sample_time, parts=PARTS,
    )  # fmt: skip
    there = run.position[starts + samples] - run.position[starts]
    moved = states[:, -1, 0] - run.position[starts]
    off = float(np.median(np.abs(np.nan_to_num(moved - there, nan=np.inf))))
    if off > _FAR * np.ptp(run.position):
        yield (
            f"the measured force would move the piston of '{model.name}' by {off:.3g} {shown('m')} more within "
            f"{samples * run.sample_time:.2g} s than it moved, and it travelled "
            f"{np.ptp(run.position):.3g} {shown('m')} in all: "
            "if a test machine imposed the motion, type --imposed, and the force is predicted; else look at the zero "
            "and unit of the force, and at the machine file's friction"
        )


def velocity_note(recording: Recording, run: Run) -> Iterator[str]:
    """A note where the recorded velocity is not the derivative of the recorded position."""
    if recording.velocity is None:
        return
    given, by_position = np.interp(run.time, recording.time, recording.velocity), run.smoothed.frame[:, 1]
    square = float(by_position @ by_position)
    if np.sqrt(square / len(by_position)) < _STEADY or np.ptp(given) == 0.0:
        return
    slope, alike = float(given @ by_position) / square, float(np.corrcoef(given, by_position)[0, 1])
    units = {f"{name}/s": 1.0 / factor for name, factor in LENGTH_UNITS.items()}
    unit = next((name for name, factor in units.items() if abs(abs(slope) / factor - 1.0) < _UNIT), "")
    if alike < -_FOLLOWS:
        yield f"the velocity counts the other way than the position{f', in {unit}' if unit else ''}; it is not used"
    elif alike < _FOLLOWS:
        yield f"the velocity does not follow the position (correlation {alike:.2f}); it is not used"
    elif unit:
        yield f"the velocity is in {unit}, it seems, not in m/s; it is not used"
