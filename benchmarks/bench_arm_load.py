"""The load of an arm from its URDF: what a diagnosis finds without it and with it.

Usage: python benchmarks/bench_arm_load.py [--out FOLDER] [--seconds S]

A boom (config/arm/lever.urdf) is moved in MuJoCo by a 40/16 cylinder on a tendon between its pins, with voltages that
take it to and fro, slowly and fast; positions and pressures are recorded with sensor noise. MuJoCo's dynamics share no
code with Pinocchio's, which turn the URDF into mass and load along the rod. The recordings are diagnosed with three
machine files: without an arm, with its mass and load at mid stroke, and with the URDF.
"""

import argparse
import tempfile
from pathlib import Path

import mujoco
import numpy as np

import pneumo_ros as pn
from pneumo_ros.couple.mujoco import Cylinders, Mount
from pneumo_ros.plant import Model, load_model
from pneumo_ros.records.writing import write_recording

ARM = Path(__file__).parents[1] / "config" / "arm"
STEP, FINER = 5e-5, 40  # s, and steps in a sample: 500 Hz
LENGTH = 0.52  # m, pin to pin at mid stroke, as in the machine file
NOISE_Y, NOISE_P = 5e-6, 300.0  # m, Pa


def boom(mass: float) -> "tuple[mujoco.MjModel, mujoco.MjData]":
    """The URDF as MJCF, with a tendon of `mass` [kg] between the pins."""
    spec = mujoco.MjSpec.from_string((ARM / "lever.urdf").read_text(encoding="utf-8"))
    spec.option.timestep, spec.option.integrator = STEP, mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.worldbody.add_site(name="base_pin", pos=[0.05, 0, 0.35])
    next(body for body in spec.bodies if body.name == "boom").add_site(name="rod_pin", pos=[0.3, 0, 0])
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
    tendon = spec.add_tendon(name="cylinder")
    tendon.wrap_site("base_pin")
    tendon.wrap_site("rod_pin")
    tendon.armature = mass  # piston and rod, which the URDF lacks
    model = spec.compile()
    return model, mujoco.MjData(model)


def voltages(seed: int, seconds: float, model: Model) -> "tuple[np.ndarray, np.ndarray]":
    """Wanted positions [m], held between 0.3 and 1.2 s, and gains [V/m]: slow and fast moves."""
    rng, count = np.random.default_rng(seed), round(seconds / (STEP * FINER))
    wanted, gain = np.zeros(count), np.zeros(count)
    at = 0
    while at < count:
        length = round(rng.uniform(0.3, 1.2) / (STEP * FINER))
        wanted[at : at + length] = rng.uniform(-0.38, 0.38) * model["piston.stroke"]
        gain[at : at + length] = rng.uniform(10.0, 40.0)
        at += length
    return wanted, gain


def record(folder: Path, machine: Model, seed: int, seconds: float) -> Path:
    """A recording of the boom in MuJoCo."""
    arm, data = boom(machine["piston.mass"])
    cylinders = Cylinders(arm, data, {"lift": Mount(machine, tendon="cylinder", length=LENGTH)}, step=STEP)
    one = cylinders.by_name["lift"]
    load = float(machine.outputs(machine.state(y=one.position)[None])["force"][0])
    p_b = 3e5
    one.cylinder.pressurise((load + machine["piston.area_b"] * p_b) / machine["piston.area_a"], p_b)
    wanted, gain = voltages(seed, seconds, machine)
    rows = []
    for target, slope in zip(wanted, gain, strict=True):
        mujoco.mj_fwdPosition(arm, data)  # the cylinder knows the position before its last step only
        position = float(data.ten_length[0]) - LENGTH
        error = target - position
        volts = float(np.clip(slope * error + 0.78 * np.sign(error) * min(abs(error) / 2e-3, 1.0), -3.5, 3.5))
        before = (position, *one.cylinder.pressures)
        for _ in range(FINER):
            cylinders.step({"lift": volts})
        rows.append((*before, volts))
    y, p_a, p_b, u = (np.array(column) for column in zip(*rows, strict=True))
    rng = np.random.default_rng(seed + 1000)
    path = folder / f"boom_{seed}"
    time = np.arange(len(y)) * STEP * FINER
    write_recording(
        path, time=time, position=y + NOISE_Y * rng.normal(size=len(y)), voltage=u,
        pressure_a=p_a + NOISE_P * rng.normal(size=len(y)), pressure_b=p_b + NOISE_P * rng.normal(size=len(y)),
    )  # fmt: skip
    return path


def middle_plain(model: Model) -> float:
    """Force [N] on the rod at mid stroke without the arm: that of the atmosphere."""
    return float(model.outputs(model.state()[None])["force"][0])


def main() -> None:
    """Record and diagnose; print both answers."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, help="keep the recordings here")
    parser.add_argument("--seconds", type=float, default=20.0, help="length of each of the three recordings")
    options = parser.parse_args()
    folder = options.out or Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    machine = load_model(ARM / "lever.yaml")
    bags = [record(folder, machine, seed, options.seconds) for seed in (1, 2, 3)]
    middle = machine.outputs(machine.state()[None])
    plain = machine.with_effects([name for name in machine.effects if name != "arm_load"])
    mass, force = float(middle["added_mass"][0]), float(middle["force"][0] - middle_plain(plain))
    constant = plain.with_effects([*plain.effects, "constant_load"])
    cases = {
        "without the arm": plain,
        "with its mass and load at mid stroke": constant.with_parameters(
            {"piston.mass": machine["piston.mass"] + mass, "constant_load.load": force}
        ),
        "with the URDF": machine,
    }
    for name, model in cases.items():
        found = pn.diagnose(bags[:2], holdout=bags[2:], model=model)
        print(f"\n{name}:\n{found}", flush=True)


if __name__ == "__main__":
    main()
