"""A mechanism with one joint, of a URDF, seen along the rod that moves it: by Pinocchio, which is optional.

The rod's position y is a function of the joint's q, with J = dy/dq. Along the rod the mechanism has the effective mass
M(q)/J^2 (Khatib 1987, A unified approach for motion and force control, eq. 51) and the potential energy E(q), with the
joint space inertia M of composite rigid bodies (Featherstone 2008, Rigid Body Dynamics Algorithms, ch. 6).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mounting:
    """Which joint of which URDF a rod moves, and how.

    between: links at both ends of the cylinder, whose distance grows as it extends; None where the joint itself slides
    as the rod does. length [m]: that distance, or the joint's position, at mid stroke. at: positions [rad, m] of the
    other joints, 0 where not named. gravity [m/s2] in the frame of the URDF's first link.
    """

    urdf: Path
    joint: str
    between: tuple[str, str] | None = None
    length: float = 0.0
    at: Mapping[str, float] | None = None
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)


class Linkage:
    """The mechanism of a mounting: geometry and dynamics as functions of the joint's position [rad or m]."""

    def __init__(self, mounting: Mounting) -> None:
        """Raises UsageError, with the nearest names, for an unknown joint or link, and for a URDF that cannot be read;
        MissingDependencyError without Pinocchio.
        """
        require_libraries(("pinocchio",))
        import pinocchio

        self._pin: Any = pinocchio
        self.mounting = mounting
        whole = self._read(mounting.urdf)
        kept = self._joint(whole, mounting.joint)
        rest = self._placed(whole, mounting.at or {})
        locked = [k for k in range(1, whole.njoints) if k != kept]
        self._model = pinocchio.buildReducedModel(whole, locked, rest)
        self._model.gravity.linear = np.array(mounting.gravity)
        self._data = self._model.createData()
        self._ends = tuple(self._link(name) for name in mounting.between or ())
        self.low, self.high = self._limits(whole, kept)
        if not self._ends and self._model.joints[1].shortname().startswith("JointModelR"):
            raise UsageError(
                f"{mounting.joint} turns; name the links at both ends of the cylinder, between: [base_pin, rod_pin]"
            )

    def _read(self, path: Path) -> Any:
        try:
            return self._pin.buildModelFromUrdf(str(path))
        except Exception as error:  # Pinocchio's own, for a missing file and for XML alike
            hint = "; compile it first: xacro FILE > arm.urdf" if path.suffix == ".xacro" else ""
            raise UsageError(f"URDF {path} cannot be read: {str(error).splitlines()[0]}{hint}") from error

    def _joint(self, model: Any, name: str) -> int:
        names = list(model.names)[1:]
        if name not in names:
            raise UsageError(unknown_name("joint of the URDF", name, names))
        number = int(model.getJointId(name))
        if model.joints[number].nv != 1:
            raise UsageError(f"joint {name} of the URDF has {model.joints[number].nv} axes; a rod moves one")
        return number

    def _link(self, name: str) -> int:
        names = [frame.name for frame in self._model.frames if frame.type == self._pin.FrameType.BODY]
        if name not in names:
            raise UsageError(unknown_name("link of the URDF", name, names))
        return int(self._model.getFrameId(name, self._pin.FrameType.BODY))

    def _placed(self, model: Any, at: Mapping[str, float]) -> Array:
        """Configuration of the whole robot with the joints `at` their positions."""
        move = np.zeros(model.nv)
        for name, position in at.items():
            move[model.joints[self._joint(model, name)].idx_v] = position
        return np.asarray(self._pin.integrate(model, self._pin.neutral(model), move))

    def _limits(self, model: Any, joint: int) -> tuple[float, float]:
        if model.joints[joint].nq != 1:  # continuous
            return -np.pi, np.pi
        index = model.joints[joint].idx_q
        low, high = float(model.lowerPositionLimit[index]), float(model.upperPositionLimit[index])
        return (low, high) if np.isfinite(low + high) and high > low else (-np.pi, np.pi)

    def rod(self, q: float) -> tuple[float, float]:
        """Position y of the rod [m], 0 at mid stroke, and J = dy/dq."""
        if not self._ends:
            return q - self.mounting.length, 1.0
        pin, model, data = self._pin, self._model, self._data
        pin.computeJointJacobians(model, data, self._configuration(q))
        pin.updateFramePlacements(model, data)
        first, last = self._ends
        apart = data.oMf[last].translation - data.oMf[first].translation
        length = float(np.linalg.norm(apart))
        frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        speed = [np.ravel(pin.getFrameJacobian(model, data, end, frame))[:3] for end in (first, last)]
        return length - self.mounting.length, float(apart @ (speed[1] - speed[0]) / max(length, 1e-12))

    def inertia(self, q: float) -> float:
        """Inertia [kg m2, or kg] of the joint."""
        return float(self._pin.crba(self._model, self._data, self._configuration(q)).flat[0])

    def energy(self, q: float) -> float:
        """Potential energy [J]."""
        return float(self._pin.computePotentialEnergy(self._model, self._data, self._configuration(q)))

    def _configuration(self, q: float) -> Array:
        pin, model = self._pin, self._model
        return np.asarray(pin.integrate(model, pin.neutral(model), np.array([q])))
