"""A chamber whose pressure does not change while the piston travels: vented, held by a regulator, or a dead sensor.

Newton's law distinguishes them. Along the motion, the momentum equation of a piston with one constant pressure leaves
what a machine file may have wrong: a load, a spring, the moving mass, friction that depends on speed or on the other
pressure. What a dead sensor does not show is a force that none of them has. Measured as a share of the other chamber's
force: 0.001 to 0.007 at constant pressures, with and without missing effects; 0.022 to 0.11 with a dead sensor.
"""

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.weak import equation_residuals
from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run
from pneumo_ros.units import shown

Array = NDArray[np.float64]
Verdict = Literal["vented", "steady", "dead", "open"]

_TRAVEL = 0.05  # m both ways
_FLAT = 1.5  # noise deviations: most that a pressure shows that does not change
_BLOCK = 0.1  # s
_ATMOSPHERE = 0.1  # relative distance from the atmosphere's pressure of a vented chamber
_LEFT, _MORE = 0.012, 0.02  # of the other chamber's force: less is left at a constant pressure, more by a dead sensor
_FEWEST = 30  # windows in which the piston slides: fewer decide nothing
_GAUGE = 0.15  # relative distance of the constant force from that of one atmosphere


def check_steady(model: Model, run: Run) -> None:
    """Raises DataError, with its verdict and what to type, for a pressure that does not change while the piston moves.

    A constant pressure of a machine without chambers is refused only where its sensor is dead.
    """
    out, back = travel(run, 0)
    if min(out, back) < _TRAVEL:  # a steady motion one way does not change the pressures; the motion back does
        if max(out, back) > _TRAVEL:
            _refuse_frozen(run, out, back)
        return
    for chamber in "ab":
        if run.pressure_of(chamber) is not None and constant(run, chamber):
            said = _sentence(model, run, chamber, verdict(model, run, chamber), out, back)
            if said:
                raise DataError(f"{run.name}: {said}")


def constant(run: Run, chamber: str) -> bool:
    """Whether the pressure of a chamber, `a` or `b`, is constant or shows noise alone."""
    signal = run.pressure_of(chamber)
    assert signal is not None
    return bool(np.ptp(signal) == 0.0 or np.std(signal) < _FLAT * run.noise[f"pressure_{chamber}_pa"])


def verdict(model: Model, run: Run, chamber: str) -> Verdict:
    """What a constant pressure of `chamber` is; `open` where the piston slides too little, or nothing pushes it."""
    left = _left(model, run, chamber)
    if left is None or _LEFT < left[0] < _MORE:
        return "open"
    if left[0] >= _MORE:
        return "dead"
    pressure = run.pressure_of(chamber)
    assert pressure is not None
    atmosphere = model["air.atmospheric_pressure"] if "air.atmospheric_pressure" in model.parameters else 101325.0
    return "vented" if abs(float(pressure.mean()) / atmosphere - 1.0) < _ATMOSPHERE else "steady"


def _left(model: Model, run: Run, chamber: str) -> tuple[float, float] | None:
    """The force that no usual mistake of a machine file explains, over the other chamber's; and the constant [N]."""
    other, area = ("b", "piston.area_b") if chamber == "a" else ("a", "piston.area_a")
    pressure = run.pressure_of(other)
    momentum = equation_residuals(model, run).get("momentum")
    if pressure is None or momentum is None or len(momentum.value) < _FEWEST:
        return None
    rows = np.clip(np.rint(momentum.time / run.sample_time).astype(int), 0, len(run) - 1)
    y, v = run.smoothed.frame[rows, 0], run.smoothed.frame[rows, 1]
    other_force = model[area] * (pressure[rows] - pressure[rows].mean())
    known = np.stack(
        [np.ones(len(rows)), np.sign(v), v, y - y.mean(), run.smoothed.acceleration[rows], other_force * np.sign(v)],
        axis=1,
    )
    size = np.maximum(np.linalg.norm(known, axis=0), 1e-12)
    found, *_ = np.linalg.lstsq(known / size, momentum.value, rcond=None)
    left = momentum.value - known / size @ found
    return float(np.std(left)) / max(float(np.std(other_force)), 1e-9), float(found[0] / size[0])


def _sentence(model: Model, run: Run, chamber: str, found: Verdict, out: float, back: float) -> str:
    """The sentence for a verdict; empty where the recording can be used as it is."""
    pressure = run.pressure_of(chamber)
    assert pressure is not None
    topic, kilo = f"chamber_{chamber}/pressure", 1e-3 * float(pressure.mean())
    motion = _motion(out, back)
    if found in ("dead", "open"):
        return _dead(chamber, pressure, motion, found == "open")
    if model.force_driven or model.imposed:
        return ""
    kind = "is vented" if found == "vented" else "is held at one pressure, by a regulator or a large vessel"
    value = "the atmosphere's" if found == "vented" else "and the forces on the piston agree"
    other = "b" if chamber == "a" else "a"
    return (
        f"chamber {chamber} {kind}: {topic} stays at {kilo:.4g} kPa, {value}, {motion}{_gauge(model, run, chamber)}. "
        f"The valve of '{model.name}' fills and empties it. To judge friction and load by both pressures, type "
        f"--read-as no-command; to judge chamber {other} and its valve, type --read-as no-pressure-{chamber}"
    )


def _gauge(model: Model, run: Run, chamber: str) -> str:
    """A hint where the constant force that is left is that of one atmosphere on the chamber's side of the piston."""
    left, side = _left(model, run, chamber), -1.0 if chamber == "b" else 1.0
    one = model[f"piston.area_{chamber}"] * model["air.atmospheric_pressure"]
    if left is None or abs(side * left[1] / one - 1.0) > _GAUGE:
        return ""
    return (
        f" (gauge pressure, it seems: {one:.3g} {shown('N')} are missing; add the atmosphere's where it is published)"
    )


def _refuse_frozen(run: Run, out: float, back: float) -> None:
    """Raises DataError for a pressure that repeats one value while the piston travels."""
    for chamber in "ab":
        pressure = run.pressure_of(chamber)
        if pressure is not None and np.ptp(pressure) == 0.0:
            raise DataError(f"{run.name}: {_dead(chamber, pressure, _motion(out, back), True)}")


def _dead(chamber: str, pressure: Array, motion: str, uncertain: bool) -> str:
    other = ", or the chamber is vented or held by a regulator, which this motion does not show" if uncertain else ""
    return (
        f"chamber_{chamber}/pressure stays at {pressure.mean():.6g} Pa, within {np.ptp(pressure):.3g} Pa of noise, "
        f"{motion}: its sensor is dead or not connected{other}; look at its plug and hose, and record again, or type "
        f"--read-as no-pressure-{chamber} to judge the recording without it"
    )


def _motion(out: float, back: float) -> str:
    return f"while the piston travels {out:.3g} {shown('m')} out and {back:.3g} {shown('m')} back"


def travel(run: Run, since: int) -> tuple[float, float]:
    """How far the piston travels out and back [m] from the sample `since` on."""
    steps = np.diff(run.position[since :: max(round(_BLOCK / run.sample_time), 1)])
    return float(steps[steps > 0.0].sum()), float(-steps[steps < 0.0].sum())
