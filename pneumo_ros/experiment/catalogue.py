"""All experiments, by the name that a user types."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from pneumo_ros.errors import UsageError
from pneumo_ros.experiment import constant_voltage, excitation, plumbing, telling
from pneumo_ros.experiment.beside import counted_from
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import centred, closed_signal, says_closed


@dataclass(frozen=True)
class Experiment:
    """Purpose of an experiment, and the function that makes its programme for a model and seconds per run."""

    purpose: str
    make: Callable[[Model, float], Programme]
    seconds: float


EXPERIMENTS = {
    "constant-voltage": Experiment(
        "constant speeds both ways: friction map, breakaway forces, flow coefficients, dead zone (pneumo identify)",
        lambda model, seconds: constant_voltage.constant_voltage(model, seconds=seconds),
        constant_voltage.SECONDS,
    ),
    "steps": Experiment(
        "random levels and pauses: refits of the whole machine, and runs to judge it by (pneumo compare --refit)",
        excitation.steps,
        excitation.SECONDS,
    ),
    "sweep": Experiment(
        "cosines of rising frequency: valve dynamics, chambers, leakage (pneumo diagnose)",
        excitation.sweep,
        excitation.SECONDS,
    ),
    "slow-reversals": Experiment(
        "slow sines a little beyond the dead zone: friction at reversal, loads that push one way (pneumo diagnose)",
        excitation.slow_reversals,
        excitation.SECONDS,
    ),
    "fast-reversals": Experiment(
        "cosines of 1 to 3 Hz: masses, delays, friction that lags (pneumo diagnose)", telling.fast_reversals, 20.0
    ),
    "full-strokes": Experiment(
        "the whole way both ways, slowly and fast: friction along the stroke", telling.full_strokes, 20.0
    ),
    "pauses": Experiment("moves after pauses of 0.1 to 60 s: friction that grows at rest", telling.pauses, 100.0),
    "hold": Experiment("20 s at closed valve at several positions: leaks, warm and cold gas", telling.hold, 5.0),
    "triangle": Experiment(
        "a slow triangle to just beyond the dead zone: offset and play of the valve", telling.triangle, 32.0
    ),
    "blocked-triangle": Experiment("the same with the piston blocked: the valve alone", telling.blocked_triangle, 32.0),
    "plumbing": Experiment(
        "ten seconds at low opening about where the piston stands: signs, units, plugs (pneumo rig check)",
        plumbing.plumbing,
        plumbing.SECONDS,
    ),
    "vent": Experiment("chambers vented, supply shut off: zero of the pressure sensors", telling.vent, 20.0),
}


def make_programme(name: str, model: Model, voltages: Sequence[float] = (), seconds: float | None = None) -> Programme:
    """The programme of the experiment `name` for `model`; `voltages` [V] are for constant-voltage only.

    Raises UsageError for an unknown experiment, with the nearest names, and for invalid values.
    """
    if name not in EXPERIMENTS:
        raise UsageError(unknown_name("experiment", name, EXPERIMENTS))
    experiment = EXPERIMENTS[name]
    make = experiment.make
    if voltages:
        if name != "constant-voltage":
            raise UsageError(f"{name} chooses its voltages itself; voltages are for constant-voltage")
        make = partial(_with_voltages, voltages)
    made = make(centred(model), experiment.seconds if seconds is None else seconds)
    return counted_from(
        made, closed_signal(model), says_closed=says_closed(model.effects, model.parameters, model.uncertainty)
    )


def _with_voltages(voltages: Sequence[float], model: Model, seconds: float) -> Programme:
    return constant_voltage.constant_voltage(model, voltages, seconds)
