"""The pruning arm in MuJoCo: two pneumatic cylinders, a branch that pushes back, a tool that is released.

Usage: python benchmarks/pruning_arm.py [--picture FILE.png] [--film FILE.gif] [--payload]

The arm is urdf/pruning_arm.urdf.xacro, compiled to MJCF. Both axes follow one trajectory: lift, reach out until the
shears press on a branch, which is a spring; go back; release the tool of 2.5 kg while the lift moves; lower. The table
prints the error of the rods beside the same with an ideal actuator, a force from the same errors without delay, and
with MuJoCo's own `cylinder` actuator: a first-order lag of the pressure, without friction, gas or valve.
--payload records the reach with the tool bolted to it and diagnoses it with the machine that has none: which effect?
"""

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import mujoco
import numpy as np

import pneumo_ros as pn
from pneumo_ros.control import Cascade, Machine, Measurement, Reference, Setpoint, ValveInverse
from pneumo_ros.control.motion import Trajectory, Waypoint
from pneumo_ros.couple.mujoco import Cylinders, Mount
from pneumo_ros.plant import Model, load_model

ROOT = Path(__file__).parents[1]
STEP, SECONDS = 1e-3, 20.0
TOOL, RELEASE = 2.5, 13.0  # kg, s
BRANCH = 3.58  # m along x, where the shears meet it
JOINTS = {"lift": "lift_piston", "reach": "reach_piston"}
WAY = {  # time [s], position [m]
    "lift": ((0.5, -0.30), (5.0, 0.10), (11.0, 0.10), (15.0, -0.10), (20.0, -0.30)),
    "reach": ((0.5, 0.00), (5.0, 0.10), (8.0, 0.33), (11.0, 0.10), (15.0, 0.00), (20.0, 0.00)),
}
MASS = {"lift": 16.8 + TOOL, "reach": 5.8 + TOOL}  # kg, what each axis moves before the tool is released
PULL, GRAVITY = 4e5, 9.81  # N/m of the ideal actuator
FINER = 20  # steps in a sample of a recording: MuJoCo's own error must stay below the sensor noise
LAG, AREA = 0.03, 1e-3  # s, m2, of MuJoCo's cylinder


def arm(lag: float = 0.0) -> "tuple[mujoco.MjModel, mujoco.MjData]":
    """The URDF as MJCF, with a tool welded to the shears and a branch on a spring; MuJoCo's cylinders if `lag` [s]."""
    import xacro

    text = xacro.process_file(str(ROOT / "urdf" / "pruning_arm.urdf.xacro")).toxml()
    text = text.replace(
        '<link name="base_link">', '<mujoco><compiler discardvisual="false"/></mujoco><link name="base_link">'
    )
    spec = mujoco.MjSpec.from_string(text)
    spec.option.timestep, spec.option.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
    world = spec.worldbody
    tip = next(body for body in spec.bodies if body.name == "reach_piston_rod")
    tip.add_geom(name="blade", type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[0.05, 0, 0], pos=[2.05, 0, 0], mass=0.0,
                 contype=1, conaffinity=1, rgba=[0.8, 0.2, 0.1, 1])  # fmt: skip
    tool = world.add_body(name="tool", pos=[3.2, 0, 3.1])
    tool.add_freejoint()
    tool.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=[0.06, 0.06, 0.09], mass=TOOL, contype=0, conaffinity=0,
                  rgba=[0.9, 0.7, 0.1, 1])  # fmt: skip
    weld = spec.add_equality(name="grip", type=mujoco.mjtEq.mjEQ_WELD, objtype=mujoco.mjtObj.mjOBJ_BODY)
    weld.name1, weld.name2 = "reach_piston_rod", "tool"
    branch = world.add_body(name="branch", pos=[BRANCH, 0, 2.2])
    branch.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0], stiffness=500.0, damping=10.0)
    branch.add_geom(type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=[0.025, 0, 0], fromto=[0, 0, 0, 0, 0, 1.6], mass=1.0,
                    contype=1, conaffinity=1, rgba=[0.35, 0.25, 0.15, 1])  # fmt: skip
    world.add_light(pos=[2, -4, 6], dir=[0, 0.6, -0.8])
    world.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE, size=[6, 6, 0.1], rgba=[0.85, 0.88, 0.85, 1], contype=0, conaffinity=0
    )
    for joint in JOINTS.values() if lag else ():
        spec.add_actuator(name=joint, target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT).set_to_cylinder(lag, 0.0, AREA)
    spec.visual.headlight.ambient = spec.visual.headlight.diffuse = [0.5, 0.5, 0.5]
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1280, 720
    model = spec.compile()
    data = mujoco.MjData(model)
    for name, joint in JOINTS.items():
        data.joint(joint).qpos[0] = WAY[name][0][1]
    mujoco.mj_forward(model, data)
    data.joint(model.body("tool").jntadr[0]).qpos[:3] = np.add(data.body("reach_piston_rod").xpos, (2.0, 0.0, -0.12))
    mujoco.mj_forward(model, data)
    relative = data.body("tool").xpos - data.body("reach_piston_rod").xpos
    rotation = data.body("reach_piston_rod").xmat.reshape(3, 3)
    model.eq_data[0, 3:6] = rotation.T @ relative
    quaternion = np.zeros(4)
    mujoco.mju_negQuat(quaternion, data.body("reach_piston_rod").xquat)
    model.eq_data[0, 6:10] = quaternion
    return model, data


def machines() -> dict[str, Model]:
    """A 63/20 cylinder that lifts and a 32/12 that reaches, each with a valve that fits it."""
    made = {}
    for name, bore, rod, flow in (("lift", 0.063, 0.020, 5.0), ("reach", 0.032, 0.012, 2.0)):
        area_a = math.pi / 4.0 * bore**2
        area_b = area_a - math.pi / 4.0 * rod**2
        axis = load_model("axis")
        made[name] = axis.with_parameters(
            {
                "piston.area_a": area_a, "piston.area_b": area_b, "piston.mass": MASS[name],
                "chambers.volume_a": area_a + 1e-4, "chambers.volume_b": area_b + 1e-4,
                "arctan_flow.filling_coefficient": flow * axis["arctan_flow.filling_coefficient"],
                "arctan_flow.exhaust_coefficient": flow * axis["arctan_flow.exhaust_coefficient"],
            }
        )  # fmt: skip
    return made


def reference(name: str) -> Reference:
    """The way of an axis, at rest at each point, with the least jerk between them."""
    points = [Waypoint(time, position, 0.0, 0.0) for time, position in WAY[name]]
    return Trajectory(Setpoint(WAY[name][0][1]), 0.0, points)


@dataclass
class Run:
    """A run of the arm: wanted and measured rod positions [m] of each axis at every step, and the cylinders' states."""

    wanted: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in JOINTS})
    found: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in JOINTS})
    pressures: dict[str, list[tuple[float, float]]] = field(default_factory=lambda: {name: [] for name in JOINTS})
    volts: dict[str, list[float]] = field(default_factory=lambda: {name: [] for name in JOINTS})
    contact: float = 0.0  # N, largest force of the branch

    def errors(self, begin: float = 1.0) -> dict[str, tuple[float, float]]:
        """rms and largest error [m] of each axis, after `begin` [s]."""
        first = round(begin / STEP)
        off = {name: np.subtract(self.wanted[name], self.found[name])[first:] for name in JOINTS}
        return {name: (float(np.sqrt(np.mean(e**2))), float(np.abs(e).max())) for name, e in off.items()}


Frame = Callable[["mujoco.MjModel", "mujoco.MjData"], None]


def pneumatic(each: Frame = lambda model, data: None) -> Run:
    """With cylinders under the cascade; `each` is called after every step."""
    model, data = arm()
    plants = machines()
    cylinders = Cylinders(model, data, {name: Mount(plants[name], joint=JOINTS[name]) for name in JOINTS})
    laws, run = {}, Run()
    for name, plant in plants.items():
        load = MASS["lift"] * GRAVITY if name == "lift" else 0.0
        known = {**plant.parameters, "constant_load.load": load}
        gains = {"damping": 450.0 * MASS[name] / 5.0, "force_rate": 135.0}
        law = Cascade(gains, ValveInverse(0.78, 0.78), Machine.of((*plant.effects, "constant_load"), known))
        laws[name] = law
        balance = 3e5
        one = cylinders.by_name[name].cylinder
        areas = plant["piston.area_a"], plant["piston.area_b"]
        rod = plant["air.atmospheric_pressure"] * (areas[0] - areas[1])
        one.pressurise((load + rod + balance * areas[1]) / areas[0], balance)  # it carries its load at the start
    ways = {name: reference(name) for name in JOINTS}

    def drive() -> None:
        volts = {}
        for name, one in cylinders.by_name.items():
            setpoint = ways[name](data.time)
            position, velocity = (float(x[0]) for x in (data.joint(JOINTS[name]).qpos, data.joint(JOINTS[name]).qvel))
            volts[name] = laws[name].step(setpoint, Measurement(data.time, position, velocity, *one.cylinder.pressures))
            run.pressures[name].append(one.cylinder.pressures)
            run.volts[name].append(volts[name])
        cylinders.step(volts)

    _follow(model, data, run, ways, drive, each)
    return run


def forced(lag: float) -> Run:
    """With the force that the errors of position and velocity ask for: at once, the ideal actuator, where `lag` is 0.

    Else by MuJoCo's actuator `cylinder`, whose pressure follows with a time constant of `lag` [s]; its gains give the
    loop a third of the bandwidth that the lag has.
    """
    model, data = arm(lag)
    ways, run = {name: reference(name) for name in JOINTS}, Run()
    weight = {"lift": MASS["lift"] * GRAVITY, "reach": 0.0}
    for k, name in enumerate(JOINTS if lag else ()):
        data.act[k] = weight[name] / AREA

    def drive() -> None:
        for k, (name, joint) in enumerate(JOINTS.items()):
            now, setpoint = data.joint(joint), ways[name](data.time)
            stiffness = MASS[name] / (3.0 * lag) ** 2 if lag else PULL
            damping = 2.0 * math.sqrt(stiffness * MASS[name])
            force = weight[name] + MASS[name] * setpoint.acceleration
            force += stiffness * (setpoint.position - now.qpos[0]) + damping * (setpoint.velocity - now.qvel[0])
            if lag:
                data.ctrl[k] = force / AREA
            else:
                data.qfrc_applied[model.joint(joint).dofadr[0]] = force
        mujoco.mj_step(model, data)

    _follow(model, data, run, ways, drive, lambda model, data: None)
    return run


def _follow(
    model: "mujoco.MjModel",
    data: "mujoco.MjData",
    run: Run,
    ways: dict[str, Reference],
    drive: Callable[[], None],
    each: Frame,
) -> None:
    blade = model.geom("blade").id
    force = np.zeros(6)
    for _ in range(round(SECONDS / STEP)):
        for name in JOINTS:
            run.wanted[name].append(ways[name](data.time).position)
            run.found[name].append(float(data.joint(JOINTS[name]).qpos[0]))
        if data.time >= RELEASE:
            data.eq_active[0] = 0
        drive()
        for k in range(data.ncon):
            if blade in (data.contact[k].geom1, data.contact[k].geom2):
                mujoco.mj_contactForce(model, data, k, force)
                run.contact = max(run.contact, float(force[0]))
        each(model, data)


def recording(drive: str, seconds: float, seed: int, name: str) -> pn.Recording:
    """The reach with the tool bolted to it under a drive such as "sine:3,0.5", with sensor noise."""
    model, data = arm()
    model.body_mass[model.body("reach_piston_rod").id] += TOOL
    mujoco.mj_setConst(model, data)
    model.opt.timestep = STEP / FINER
    data.joint(JOINTS["lift"]).qpos[0], data.eq_active[0] = WAY["lift"][0][1], 0  # the weld is softer than a bolt
    plant = machines()["reach"]
    cylinders = Cylinders(model, data, {"reach": Mount(plant, joint=JOINTS["reach"])})
    lift = model.joint(JOINTS["lift"]).dofadr[0]
    model.dof_damping[lift] = 1e6  # clamped
    cylinders.by_name["reach"].cylinder.pressurise(3.5e5, 4e5)
    free = pn.simulate(plant, drive, seconds=seconds)  # its clock and its commands
    rows = []
    for voltage in free.signals["voltage"]:
        one = cylinders.by_name["reach"]
        pressures = one.cylinder.pressures
        rows.append((float(data.joint(JOINTS["reach"]).qpos[0]), *pressures))
        for _ in range(FINER):
            cylinders.step({"reach": float(voltage)})
    random = np.random.default_rng(seed)
    y, p_a, p_b = np.array(rows).T + random.normal(size=(3, len(rows))) * np.array([[5e-6], [200.0], [200.0]])
    return replace(free, name=name, position=y, pressure_a=p_a, pressure_b=p_b, velocity=None, effort=None)


def payload() -> None:
    """Print what a diagnosis says of a tool that the model does not know."""
    bare = machines()["reach"].with_parameters({"piston.mass": MASS["reach"] - TOOL})
    drives = {"slow": "sine:2.5,0.7", "fast": "sine:5,1.5", "hold": "sine:4,1.1"}
    runs = {name: recording(drive, 8.0, k, name) for k, (name, drive) in enumerate(drives.items())}
    print(pn.diagnose([runs["slow"], runs["fast"]], runs["hold"], bare))


def pictures(every: float = 0.2) -> tuple[Frame, list[np.ndarray]]:
    """A function for `pneumatic` that renders a frame each `every` [s] of simulated time, and the frames."""
    frames: list[np.ndarray] = []
    camera = mujoco.MjvCamera()
    camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = (1.9, 0.0, 2.0), 4.6, 90.0, -6.0
    renderer: list[mujoco.Renderer] = []

    def each(model: "mujoco.MjModel", data: "mujoco.MjData") -> None:
        if data.time >= every * len(frames):
            if not renderer:
                renderer.append(mujoco.Renderer(model, 360, 640))
            renderer[0].update_scene(data, camera)
            frames.append(renderer[0].render().copy())

    return each, frames


def main() -> None:
    """Print the table; write the picture and the film that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--picture", metavar="FILE.png", help="the arm at four moments")
    parser.add_argument("--film", metavar="FILE.gif", help="the whole run, ten times as fast")
    parser.add_argument("--payload", action="store_true", help="diagnose the tool from recordings, instead")
    options = parser.parse_args()
    if options.payload:
        payload()
        return
    each, frames = pictures() if options.picture or options.film else (lambda model, data: None, [])
    runs = {
        "cylinders under the cascade": pneumatic(each),
        "ideal actuator": forced(0.0),
        "MuJoCo's `cylinder`, lag 30 ms": forced(LAG),
    }
    print("| actuator | lift rms | lift largest | reach rms | reach largest | branch pushes |")
    print("|---|---|---|---|---|---|")
    for name, run in runs.items():
        (lift, lift_most), (reach, reach_most) = (run.errors()[axis] for axis in JOINTS)
        cells = " | ".join(f"{1e3 * x:.2f} mm" for x in (lift, lift_most, reach, reach_most))
        print(f"| {name} | {cells} | {run.contact:.0f} N |")
    if frames:
        from PIL import Image

        images = [Image.fromarray(one) for one in frames]
        if options.picture:
            chosen = [images[min(round(t / 0.2), len(images) - 1)] for t in (1.0, 8.0, 13.4, 19.5)]
            whole = Image.new("RGB", (1280, 720))
            for k, one in enumerate(chosen):
                whole.paste(one, (640 * (k % 2), 360 * (k // 2)))
            whole.save(options.picture)
        if options.film:
            small = [one.resize((480, 270)) for one in images]
            small[0].save(options.film, save_all=True, append_images=small[1:], duration=100, loop=0, optimize=True)


if __name__ == "__main__":
    main()
