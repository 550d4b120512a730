"""Motions that rate a control law: a sine and moves, on the machine and on a harsher one."""

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from pneumo_ros.control.closed_loop import closed_loop
from pneumo_ros.control.figures import arrivals, tracking
from pneumo_ros.control.reference import moves, sine
from pneumo_ros.control.sensors import NoisySensors
from pneumo_ros.control.tuning import NOISE_SEED, RatedMotion
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Stepper

if TYPE_CHECKING:
    from pneumo_ros.control.law import Law
    from pneumo_ros.plant import Model

SAMPLE_TIME = 1e-3  # s
AMPLITUDE, STEP = 0.15, 0.03  # of the stroke: 0.3 m and 60 mm of the default machine
SINE_SPEED, MOVE_SPEED = 0.64, 0.77  # greatest speeds, of the machine's speed at full voltage
MOVE_FORCE = 0.3  # greatest accelerating force, of the force of the supply on the smaller area
HARSHER, HEAVIER = 1.2, 2.0  # times friction and mass, of the harsher machine
SPOOL = "valve_spool_dynamics"
REACH = 0.45  # of the stroke, to either side
SLOWEST = 1e-3  # m/s; a machine with a lower top speed is refused
HOLD = 4.0  # s after each move
RUN_UP = 0.2  # of a period of the sine, not judged
JUDGED = 8.0  # s of the sine at least, in whole periods
TOLERANCE = 3e-4  # m


@dataclass(frozen=True)
class Task:
    """A sine of `amplitude` [m] and `frequency` [Hz], and moves of `step` [m] in `duration` [s]."""

    amplitude: float
    frequency: float
    step: float
    duration: float


def task_for(
    model: "Model", amplitude: float | None = None, frequency: float | None = None, step: float | None = None
) -> Task:
    """Values that are not given follow from stroke and speed of the machine.

    Raises UsageError for motions that leave the stroke, and for a machine that hardly moves.
    """
    stroke, top = model["piston.stroke"], top_speed(model)
    height, way = amplitude or AMPLITUDE * stroke, step or STEP * stroke
    for name, size in (("amplitude", height), ("step", way)):
        if size > REACH * stroke:
            raise UsageError(f"--{name} is {size:g} m; the stroke of {stroke:g} m allows {REACH * stroke:g} m")
    if top < SLOWEST:
        raise UsageError(
            f"{model.name} reaches {top:.2g} m/s with its valve fully open, and a control law cannot make it faster; "
            "look at supply_pressure, friction and flow coefficients in the machine file"
        )
    return Task(height, frequency or _frequency(model, height, top), way, _duration(model, way, top))


def _frequency(model: "Model", amplitude: float, top: float) -> float:
    """A sine reaches the speed amplitude w and the acceleration amplitude w^2: the axis must be able to do both."""
    by_force = np.sqrt(MOVE_FORCE * _force(model) / (model["piston.mass"] * amplitude))
    return float(min(SINE_SPEED * top / amplitude, by_force) / (2.0 * np.pi))


def _duration(model: "Model", way: float, top: float) -> float:
    """A move of least jerk reaches 1.875 way / T and 5.77 way / T^2."""
    by_force = np.sqrt(5.77 * way * model["piston.mass"] / (MOVE_FORCE * _force(model)))
    return float(max(1.875 * way / (MOVE_SPEED * top), by_force))


def _force(model: "Model") -> float:
    """Of the supply on the smaller area, less what friction takes of it, but for a tenth [N]."""
    supply = model["air.supply_pressure"] - model["air.atmospheric_pressure"]
    whole = min(model["piston.area_a"], model["piston.area_b"]) * supply
    return float(max(whole - model.parameters.get("lugre_friction.coulomb_friction", 0.0), 0.1 * whole))


def reached(model: "Model", task: Task, law: "Law") -> tuple[float, float]:
    """What `law` reaches on the machine: rms error along the sine, and the largest error at the end of a move [m]."""
    wave, ways = rated_motions(model, task)[:2]
    records = []
    for motion in (wave, ways):
        law.reset()
        plant = motion.plant()
        samples = round(motion.seconds / plant.sample_time)
        records.append(closed_loop(plant, law, motion.reference, samples, NoisySensors(seed=NOISE_SEED)))
    ends = arrivals(records[1], ways.hold or 1.0, ways.unit)
    return tracking(records[0], wave.begin).rms, max(end.error for end in ends)


def top_speed(model: "Model", voltage: float = 10.0) -> float:
    """Speed [m/s] that the machine reaches at +-`voltage` [V] from the far end of its stroke; the smaller of both."""
    speeds = []
    for sign in (1.0, -1.0):
        begin = begin_at(model, -0.4 * sign * model["piston.stroke"])
        ran = model.simulate(np.full(20_000, sign * voltage), begin, sample_time=SAMPLE_TIME)
        inside = np.abs(ran[:, 0]) < 0.45 * model["piston.stroke"]
        speeds.append(float(np.max(sign * ran[inside, 1])))
    return min(speeds)


def begin_at(model: "Model", position: float) -> np.ndarray:
    """State (states,) at rest at `position` [m], the forces of both chambers in balance at half of the supply."""
    p_0, p_s = model["air.atmospheric_pressure"], model["air.supply_pressure"]
    p_a = p_0 + 0.4 * (p_s - p_0)
    drive = model["piston.area_a"] * (p_a - p_0)
    return model.state(y=position, p_a=p_a, p_b=p_0 + drive / model["piston.area_b"])


def stepper(model: "Model", position: float = 0.0) -> Stepper:
    """The machine at rest at `position` [m], stepped at 1 kHz."""
    return Stepper(model, begin_at(model, position), sample_time=SAMPLE_TIME)


def harsher(model: "Model", spool: float | None = None) -> "Model":
    """The same machine with more friction and mass, and a `spool` of that angular frequency [rad/s]."""
    factors = {
        "piston.mass": HEAVIER,
        "lugre_friction.static_friction": HARSHER,
        "lugre_friction.coulomb_friction": HARSHER,
    }
    other = model.with_parameters({n: f * model[n] for n, f in factors.items() if n in model.parameters})
    if spool is None:
        return other
    effects = [name for name in model.effects if name != SPOOL]
    return other.with_effects([*effects, SPOOL], {f"{SPOOL}.angular_frequency": spool})


def rated_motions(model: "Model", task: Task, spool: float | None = None) -> list[RatedMotion]:
    """The sine and six moves, each on the machine and on the harsher one."""
    period, levels = 1.0 / task.frequency, [k * task.step for k in (-1, 0, -1, 0, 1, 0, -1)]
    whole = max(np.ceil(JUDGED / period), 1.0)
    wave, ways = sine(task.amplitude, task.frequency), moves(levels, HOLD + task.duration, task.duration)
    hold = HOLD + task.duration
    found = []
    for machine in (model, harsher(model, spool)):
        found.append(RatedMotion(partial(stepper, machine), wave, (whole + RUN_UP) * period, RUN_UP * period))
        found.append(
            RatedMotion(partial(stepper, machine, levels[0]), ways, len(levels) * hold, hold=hold, unit=TOLERANCE)
        )
    return found
