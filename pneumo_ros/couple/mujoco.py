"""Cylinders of machine files on named tendons, joints and sites of any MJCF model.

    arm = mujoco.MjModel.from_xml_path("arm.xml")
    data = mujoco.MjData(arm)
    cylinders = Cylinders(arm, data, {"lift": Mount(load_model("my.yaml"), tendon="lift", length=0.42)})
    while data.time < 10.0:
        cylinders.step({"lift": 2.5})  # volts

`step` replaces mj_step: it asks each cylinder for its mean force over the step, and applies it through the Jacobian of
its tendon, joint or pair of sites. Needs `pip install mujoco`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.couple.cylinder import Cylinder
from pneumo_ros.couple.places import BetweenSites, OnJoint, OnTendon, Place
from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.model import STEP, Model

require_libraries(("mujoco",))
import mujoco  # noqa: E402 - after the sentence that says how to install it

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mount:
    """Where a cylinder is: on a `tendon`, a `joint` (slide) or between two `sites`, and its `length` at mid stroke.

    length: of the tendon, between the sites, or the joint's position [m], at mid stroke. sign: 1 where that rises as
    the rod extends; -1 otherwise.
    """

    machine: Model
    tendon: str | None = None
    joint: str | None = None
    sites: tuple[str, str] | None = None
    length: float = 0.0
    sign: float = 1.0


@dataclass
class Mounted:
    """A cylinder at its mount: `force` [N] over the last step, `position` [m] and `velocity` [m/s] at its begin."""

    cylinder: Cylinder
    mount: Mount
    place: Place
    force: float = 0.0
    position: float = 0.0
    velocity: float = 0.0
    mass: float = 0.0  # effective [kg]
    jacobian: Array = field(default_factory=lambda: np.zeros(0))  # (nv,) of the rod's position


class Cylinders:
    """The cylinders of one MuJoCo model, by name."""

    def __init__(
        self, model: "mujoco.MjModel", data: "mujoco.MjData", mounts: Mapping[str, Mount], *, step: float = STEP
    ) -> None:
        """Attach `mounts`, chambers at atmospheric pressure; gas and friction are integrated in `step` [s] or shorter.

        Raises UsageError, with the nearest names, for a tendon, joint or site that `model` lacks, for a joint that does
        not slide, for a rod outside its stroke, and for an integrator other than Euler and implicitfast.
        """
        allowed = (mujoco.mjtIntegrator.mjINT_EULER, mujoco.mjtIntegrator.mjINT_IMPLICITFAST)
        if model.opt.integrator not in allowed:
            raise UsageError(
                "the model's integrator takes several stages a step; set integrator='implicitfast' in <option>"
            )
        self._model, self._data = model, data
        mujoco.mj_forward(model, data)
        self.by_name = {name: self._mounted(name, mount, step) for name, mount in mounts.items()}
        self._solved, self._given = np.zeros((1, model.nv)), np.zeros(model.nv)

    def _mounted(self, name: str, mount: Mount, step: float) -> Mounted:
        given = [one for one in ("tendon", "joint", "sites") if getattr(mount, one) is not None]
        if len(given) != 1:
            has = " and ".join(given) or "none"
            raise UsageError(f"cylinder {name} takes one of tendon, joint and sites; it has {has}")
        place: Place
        if mount.tendon is not None:
            place = OnTendon(self._model, self._data, mount.tendon)
        elif mount.joint is not None:
            place = OnJoint(self._model, self._data, mount.joint)
        else:
            place = BetweenSites(self._model, self._data, mount.sites or ("", ""))
        one = Mounted(Cylinder(mount.machine, step=step), mount, place, jacobian=np.zeros(self._model.nv))
        position = self._position(one)
        reach = 0.5 * mount.machine["piston.stroke"]
        if abs(position) > reach:
            raise UsageError(
                f"the rod of {name} begins at {position:.4g} m, outside of its stroke of +-{reach:g} m; set length, "
                f"that of its {given[0]} at mid stroke (now {mount.length:g} m)"
            )
        one.cylinder.reset(position)
        self._jacobian(one, one.jacobian)
        return one

    # --- every step -------------------------------------------------------------------------------------------------

    def step(self, voltages: Mapping[str, float]) -> None:
        """One step of the model with `voltages` [V] at the valves by name; a valve that is not named is closed.

        What `data.qfrc_applied` holds besides is kept. Raises UsageError for an unknown name, NumericalError when a
        cylinder's state leaves the finite numbers.
        """
        for name in voltages:
            if name not in self.by_name:
                raise UsageError(unknown_name("cylinder", name, self.by_name))
        model, data = self._model, self._data
        mujoco.mj_step1(model, data)
        mujoco.mj_fwdActuation(model, data)
        self._given[:] = data.qfrc_applied
        others = self._given + data.qfrc_constraint  # the contacts of the last step
        for one in self.by_name.values():
            others += one.force * one.jacobian
        mujoco.mj_fwdAcceleration(model, data)  # qfrc_smooth, with what was applied from outside
        for name, one in self.by_name.items():
            others -= one.force * one.jacobian
            drift = self._look(one)
            mujoco.mj_solveM(model, data, self._solved, one.jacobian[np.newaxis])
            one.mass = 1.0 / max(float(self._solved[0] @ one.jacobian), 1e-9)
            free = float(self._solved[0] @ (data.qfrc_smooth - self._given + others)) + drift
            one.force = one.cylinder.step(
                one.position, one.velocity, one.mass, free, model.opt.timestep, voltages.get(name, 0.0)
            )
            others += one.force * one.jacobian
        for one in self.by_name.values():
            data.qfrc_applied += one.force * one.jacobian
        mujoco.mj_step2(model, data)
        data.qfrc_applied[:] = self._given

    def _look(self, one: Mounted) -> float:
        """Take position, velocity and Jacobian; returns J' q' [m/s2], from the last step."""
        before = one.jacobian.copy()
        self._jacobian(one, one.jacobian)
        one.position = self._position(one)
        one.velocity = float(one.jacobian @ self._data.qvel)
        return float((one.jacobian - before) @ self._data.qvel / self._model.opt.timestep)

    def _position(self, one: Mounted) -> float:
        return one.mount.sign * (one.place.length() - one.mount.length)

    def _jacobian(self, one: Mounted, out: Array) -> None:
        """The row of the rod's position, (nv,)."""
        one.place.row(out)
        out *= one.mount.sign
