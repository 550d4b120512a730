"""Identification from a campaign of constant-voltage runs: the paper's procedure, with intervals and reasons.

1. stretches of constant velocity and pressures -> static map -> F_c, C_d (viscous coefficient, if requested)
2. breakaways from rest -> F_s; the motion that follows them -> v_s, and F_s again
3. the mass balance of the same stretches -> flow coefficients and dead zone
4. presliding -> bristle stiffness; Eqs. 15-16, corrected, for parameters it does not show

Machines with on/off valves or regulators have no steady flow, those in a position loop no constant command, and a
piston that sticks and slips no constant velocity: see `by_motion`.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pneumo_ros.equations.breakaway import Breakaway, find_breakaways
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.identify.assembly import ADDED, COULOMB, DRAG, STATIC, STRIBECK, Assembly, Found
from pneumo_ros.identify.by_motion import fit_by_motion, needs_motion
from pneumo_ros.identify.flow import coefficients
from pneumo_ros.identify.friction_map import fit_map
from pneumo_ros.identify.static_map import MapFit, MapPoint, map_points
from pneumo_ros.identify.steady import TRAVEL, Window, find_windows
from pneumo_ros.plant import Model
from pneumo_ros.runs.run import Run, check_position
from pneumo_ros.shooting.refit import to_fit

Progress = Callable[[float, str], None]

FRICTION = (STATIC, COULOMB, STRIBECK, DRAG, *ADDED)  # of the static map, where the model has them


@dataclass(frozen=True)
class Identification:
    """Result of a campaign: the model, every fitted parameter, and the evidence.

    undetermined: requested parameters that the runs do not determine, with a sentence each; they keep their old values.
    correlations: pairs of parameters fitted together, -1 to 1.
    """

    before: Model
    model: Model
    parameters: dict[str, Found]
    undetermined: dict[str, str]
    correlations: dict[tuple[str, str], float]
    windows: tuple[Window, ...]
    points: tuple[MapPoint, ...]
    breakaways: tuple[Breakaway, ...]
    map_fit: MapFit
    why_motion: str = ""  # why parameters were fitted by the motion in `segments`, where there is no static map
    segments: int = 0
    misfit: float = float("nan")  # root mean square of their predictions over the noise


def identify(
    model: Model, runs: Sequence[Run], *, free: Sequence[str] = FRICTION, progress: Progress | None = None
) -> Identification:
    """Identify friction, and where there is a valve its flow coefficients, from constant-voltage runs.

    `free` are the friction parameters to fit; those the model does not have are ignored, and those that its machine
    file states to be known exactly. Runs may differ in sample time. Without one steady stretch all is fitted by the
    motion. Raises UsageError for a model without LuGre friction, or with all of `free` known exactly, DataError when
    the runs hold too few steady stretches or no motion, or leave the stroke.
    """
    tell = progress or (lambda share, text: None)
    tell(0.0, "looking for steady stretches")
    _check(model, runs)
    if why := needs_motion(model):
        return _by_motion(model, runs, why, free, tell)
    windows = tuple(w for run in runs for w in find_windows(model, run))
    points = tuple(map_points(windows))
    if not points:
        why = _unsteady(runs, windows, "force" if model.force_driven else "voltage")
        return replace(_by_motion(model, runs, why, free, tell), windows=windows)
    breakaways = tuple(b for run in runs for b in find_breakaways(model, run))
    tell(0.2, f"{len(points)} steady points, {len(breakaways)} breakaways")
    wanted = to_fit(model, free)
    if not wanted:
        raise UsageError(
            f"no friction parameter of {model.name} is to be identified: its machine file states that "
            f"{', '.join(name for name in free if name in model.exact)} are known exactly; give one a deviation above 0"
        )
    result = Assembly(model, wanted, fit_map(model, points, breakaways, wanted))
    if not model.force_driven:
        result.flow(windows)
    result.presliding(runs, breakaways)
    tell(0.4, "fitting the motion after breakaways")
    result.motion(runs, breakaways, lambda share, text: tell(0.4 + 0.6 * share, text))
    result.map_again(points, breakaways)
    asked = (*wanted, *to_fit(model, coefficients(model)))
    unknown = {name: result.unknown[name] for name in asked if name in result.unknown}
    return Identification(
        model, result.model, result.found, unknown, result.correlations, windows, points, breakaways, result.map_fit
    )


def _by_motion(model: Model, runs: Sequence[Run], why: str, free: Sequence[str], tell: Progress) -> Identification:
    """Without a static map, for the reason `why`: all parameters together, from any motion."""
    found = fit_by_motion(model, runs, free, tell)
    empty = np.empty(0)
    nothing = MapFit({}, {}, np.empty((0, 0)), (), empty, empty, float("nan"), {})
    return Identification(
        model, found.model, found.parameters, found.undetermined, {}, (), (), (), nothing, why, found.segments,
        found.misfit,
    )  # fmt: skip


def _check(model: Model, runs: Sequence[Run]) -> None:
    if "lugre_friction" not in model.effects:
        raise UsageError(
            f"{model.name} has no LuGre friction, whose parameters are identified here; "
            "add lugre_friction to the effects of the machine file"
        )
    names = [run.name for run in runs]
    if repeated := sorted({name for name in names if names.count(name) > 1}):
        raise UsageError(f"{repeated[0]} is given twice; give each recording once, and each its own name")
    for run in runs:
        check_position(model, run)


def _unsteady(runs: Sequence[Run], windows: Sequence[Window], held: str) -> str:
    """Why there is no steady stretch. Raises DataError where the piston does not move either."""
    why = f"The {held} is nowhere constant for a quarter of a second"
    if windows:
        reasons = [w.reason for w in windows]
        common = max(set(reasons), key=reasons.count)
        why = f"No stretch of constant velocity in {len(windows)} windows of constant {held}"
        why += f" ({reasons.count(common)} times: {common})"
    if any(float(np.ptp(run.position)) > TRAVEL for run in runs):
        return why
    raise DataError(
        f"{why[0].lower()}{why[1:]}, and no motion to fit instead; record runs in which the piston moves: "
        "pneumo experiment constant-voltage"
    )
