"""The section `arm_load` of a machine file: a URDF and a joint become the coefficients of the effect.

arm_load: {urdf: arm.urdf, joint: shoulder, between: [base_pin, rod_pin], length: 0.42, at: {elbow: 0.5}}
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from pneumo_ros.errors import UsageError, brief
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.effects.piston.arm_load import ArmLoad
from pneumo_ros.plant.linkage import Linkage, Mounting

Array = NDArray[np.float64]

SECTION = ArmLoad.name
KEYS = ("urdf", "joint", "between", "length", "at", "gravity")
DEGREE = sum(name.startswith("energy_") for name in ArmLoad.parameters)
NODES = 6 * DEGREE  # positions along the stroke at which Pinocchio is asked
BEYOND = 1.02  # of half the stroke: end stops yield
GRID = 2001  # joint positions between which the rod's positions are interpolated before Newton's steps
NEWTON = 8  # steps, which double the digits
BENT = 2e-3  # of the largest mass or load: a worse fit of the polynomials is refused; sensors show some per cent


def coefficients(given: Mapping[str, Any], stroke: object, folder: Path) -> dict[str, float]:
    """Parameters of `arm_load` for a section that names a URDF, relative to `folder`, and the `stroke` [m].

    Raises UsageError, with the nearest names, for unknown keys, joints and links, for a stroke that the linkage does
    not reach or that passes a dead point, and for a load that the polynomials do not describe.
    """
    if not isinstance(stroke, int | float) or not stroke > 0.0:
        raise UsageError(f"piston.stroke is {brief(stroke)}; arm_load needs it, in m, to follow the joint along it")
    linkage = Linkage(_mounting(given, folder))
    reach = 0.5 * float(stroke)
    x = BEYOND * chebyshev.chebpts1(NODES)
    q = _joint_positions(linkage, reach * x)
    lever = np.array([linkage.rod(position)[1] for position in q])
    mass = np.array([linkage.inertia(position) for position in q]) / lever**2
    energy = np.array([linkage.energy(position) for position in q])
    fits = {name: _fit(x, values) for name, values in (("mass", mass), ("energy", energy))}
    _check(fits["mass"], x, mass, "mass", "kg")
    _check(np.asarray(chebyshev.chebder(fits["energy"]) / reach), x, _slope(linkage, q, lever), "load", "N")
    named = {f"{kind}_{k}": float(value) for kind, fit in fits.items() for k, value in enumerate(fit)}
    largest = {kind: float(np.abs(fit).max()) for kind, fit in fits.items()}
    return {
        name: value if abs(value) > 1e-12 * largest[name.partition("_")[0]] else 0.0
        for name, value in named.items()
        if name in ArmLoad.parameters
    }


def _mounting(given: Mapping[str, Any], folder: Path) -> Mounting:
    for key in given:
        if key not in KEYS and not key.startswith("at."):  # as ROS writes a nested parameter
            raise UsageError(f"section {SECTION}: {unknown_name('entry', str(key), KEYS)} (it names a URDF)")
    at = {**_section(given.get("at", {}), "at"), **{k[3:]: v for k, v in given.items() if k.startswith("at.")}}
    between, gravity = given.get("between"), given.get("gravity", Mounting.gravity)
    if between is not None and not (isinstance(between, list) and len(between) == 2):
        raise UsageError(f"{SECTION}.between is {brief(between)}; it takes two links: [base_pin, rod_pin]")
    if not isinstance(gravity, list | tuple) or len(gravity) != 3:
        raise UsageError(f"{SECTION}.gravity is {brief(gravity)}; it takes three numbers in m/s2: [0, 0, -9.81]")
    return Mounting(
        folder / str(given["urdf"]),
        str(given.get("joint", "")),
        (str(between[0]), str(between[1])) if between else None,
        _number(given.get("length", 0.0), "length"),
        {str(name): _number(position, f"at.{name}") for name, position in at.items()},
        (_number(gravity[0], "gravity"), _number(gravity[1], "gravity"), _number(gravity[2], "gravity")),
    )


def _section(given: object, name: str) -> dict[str, Any]:
    if not isinstance(given, dict):
        raise UsageError(f"{SECTION}.{name} is {brief(given)}; it takes joints and positions: {{elbow: 0.5}}")
    return given


def _number(value: object, name: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
        raise UsageError(f"{SECTION}.{name} is {brief(value)}; it takes a finite number")
    return float(value)


def _joint_positions(linkage: Linkage, wanted: Array) -> Array:
    """Joint positions [rad or m] at which the rod is at `wanted` [m]; UsageError where it cannot be."""
    half = np.pi if linkage.mounting.between else float(np.abs(wanted).max()) + abs(linkage.mounting.length)
    middle = 0.5 * (linkage.low + linkage.high)
    grid = np.linspace(middle - half, middle + half, GRID)
    y = np.array([linkage.rod(q)[0] for q in grid])
    grid, y = _branch(linkage, grid, y)
    if wanted.min() < y.min() or wanted.max() > y.max():
        raise UsageError(
            f"{linkage.mounting.joint} moves the rod from {y.min():.4g} to {y.max():.4g} m between its dead points; "
            f"the stroke needs {wanted.min():.4g} to {wanted.max():.4g} m: check {SECTION}.length and piston.stroke"
        )
    order = np.argsort(y)
    q = np.interp(wanted, y[order], grid[order])
    for _ in range(NEWTON):
        found = np.array([linkage.rod(position) for position in q])
        q = q - (found[:, 0] - wanted) / found[:, 1]
    return np.asarray(q)


def _branch(linkage: Linkage, grid: Array, y: Array) -> tuple[Array, Array]:
    """The part of `grid`, between dead points, in which the rod is at mid stroke within the joint's limits."""
    cross = np.flatnonzero(np.diff(y >= 0.0))
    inside = [k for k in cross if linkage.low <= 0.5 * (grid[k] + grid[k + 1]) <= linkage.high]
    if len(inside) != 1:
        seen = y[(grid >= linkage.low) & (grid <= linkage.high)] + linkage.mounting.length
        raise UsageError(
            f"{SECTION}.length, {linkage.mounting.length:g} m, is reached {len(inside)} times within the limits of "
            f"{linkage.mounting.joint}, where the cylinder is {seen.min():.4g} to {seen.max():.4g} m long; once is "
            "needed: give the length at mid stroke, or narrower limits in the URDF"
        )
    way = np.sign(np.diff(y))
    turns = np.flatnonzero(way != way[inside[0]])
    first = max((int(k) + 1 for k in turns if k < inside[0]), default=0)
    last = min((int(k) for k in turns if k > inside[0]), default=len(way))
    return grid[first : last + 1], y[first : last + 1]


def _fit(x: Array, values: Array) -> Array:
    return np.asarray(chebyshev.chebfit(x, values, DEGREE), dtype=float)


def _slope(linkage: Linkage, q: Array, lever: Array) -> Array:
    """Force [N] of the weight along the rod, by central differences of the energy."""
    step = 1e-5
    return np.array([linkage.energy(p + step) - linkage.energy(p - step) for p in q]) / (2.0 * step * lever)


def _check(fit: Array, x: Array, values: Array, what: str, unit: str) -> None:
    error, largest = np.abs(chebyshev.chebval(x, fit) - values)[np.abs(x) <= 1.0].max(), np.abs(values).max()
    if error > BENT * largest and error > 1e-6:
        raise UsageError(
            f"the {what} of the arm along the rod changes from {values.min():.4g} to {values.max():.4g} {unit}, too "
            f"fast for polynomials of degree {DEGREE}: the stroke ends close to a dead point; shorten it"
        )
