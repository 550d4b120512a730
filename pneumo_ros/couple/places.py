"""Where a cylinder is on an MJCF model: on a tendon, a joint that slides, or between two sites."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

require_libraries(("mujoco",))
import mujoco  # noqa: E402 - after the sentence that says how to install it

Array = NDArray[np.float64]


class Place(Protocol):
    """A length [m] of the mechanism, and its Jacobian (nv,) by the joint velocities."""

    def length(self) -> float:
        """As it is now."""
        ...

    def row(self, out: Array) -> None:
        """Fill `out` (nv,)."""
        ...


def find(model: "mujoco.MjModel", kind: "mujoco.mjtObj", name: str) -> int:
    """Index of a named joint, tendon or site; UsageError with the nearest names."""
    row = int(mujoco.mj_name2id(model, kind, name))
    if row < 0:
        what = {mujoco.mjtObj.mjOBJ_TENDON: "tendon", mujoco.mjtObj.mjOBJ_JOINT: "joint"}.get(kind, "site")
        count = {"tendon": model.ntendon, "joint": model.njnt, "site": model.nsite}[what]
        names = [mujoco.mj_id2name(model, kind, k) or "" for k in range(count)]
        raise UsageError(unknown_name(what, name, names))
    return row


class OnTendon:
    """Along a tendon."""

    def __init__(self, model: "mujoco.MjModel", data: "mujoco.MjData", name: str) -> None:
        self._model, self._data = model, data
        self._at = find(model, mujoco.mjtObj.mjOBJ_TENDON, name)

    def length(self) -> float:
        """Of the tendon."""
        return float(self._data.ten_length[self._at])

    def row(self, out: Array) -> None:
        """Of the tendon's Jacobian, which newer versions of MuJoCo store without its zeros."""
        out[:] = 0.0
        rows = np.asarray(self._data.ten_J)
        if rows.shape == (self._model.ntendon, self._model.nv) and not hasattr(self._model, "ten_J_rownnz"):
            out[:] = rows[self._at]
            return
        begin, count = int(self._model.ten_J_rowadr[self._at]), int(self._model.ten_J_rownnz[self._at])
        places = self._model.ten_J_colind.ravel()[begin : begin + count]
        out[places] = rows.ravel()[begin : begin + count]


class OnJoint:
    """Along a joint that slides."""

    def __init__(self, model: "mujoco.MjModel", data: "mujoco.MjData", name: str) -> None:
        at = find(model, mujoco.mjtObj.mjOBJ_JOINT, name)
        if model.jnt_type[at] != mujoco.mjtJoint.mjJNT_SLIDE:
            raise UsageError(f"joint {name} does not slide; put the cylinder on a tendon, or between two sites")
        self._data, self._q, self._v = data, int(model.jnt_qposadr[at]), int(model.jnt_dofadr[at])

    def length(self) -> float:
        """The joint's position."""
        return float(self._data.qpos[self._q])

    def row(self, out: Array) -> None:
        """1 at the joint."""
        out[:] = 0.0
        out[self._v] = 1.0


class BetweenSites:
    """On the straight line between two sites, as of a cylinder with a pin at either end."""

    def __init__(self, model: "mujoco.MjModel", data: "mujoco.MjData", names: tuple[str, str]) -> None:
        self._model, self._data = model, data
        self._first, self._last = (find(model, mujoco.mjtObj.mjOBJ_SITE, name) for name in names)
        self._jacobians = np.zeros((2, 3, model.nv))

    def length(self) -> float:
        """From pin to pin."""
        return float(np.linalg.norm(self._apart()))

    def row(self, out: Array) -> None:
        """Of the distance: n (J_last - J_first), n the direction from the first to the last site."""
        apart, (first, last) = self._apart(), self._jacobians
        mujoco.mj_jacSite(self._model, self._data, first, None, self._first)
        mujoco.mj_jacSite(self._model, self._data, last, None, self._last)
        out[:] = (apart / max(float(np.linalg.norm(apart)), 1e-12)) @ (last - first)

    def _apart(self) -> Array:
        return np.asarray(self._data.site_xpos[self._last] - self._data.site_xpos[self._first])
