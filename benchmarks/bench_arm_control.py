"""A boom under the control laws: its mass and weight as its URDF has them, against those at mid stroke.

Usage: python benchmarks/bench_arm_control.py [--seconds S]

The boom of config/arm/lever.urdf is moved in MuJoCo by a 40/16 cylinder on a tendon, as in bench_arm_load.py: its mass
along the rod is 84 to 205 kg, its weight 250 to 350 N. A law follows moves of least jerk over most of the stroke, and
knows the arm by `arm_load`, or by `piston.mass` and `constant_load` as they are at mid stroke. Both have the same
gains. Position and pressures have the noise of sensors.
"""

import argparse

import mujoco
import numpy as np
from bench_arm_load import ARM, LENGTH, NOISE_P, NOISE_Y, boom, middle_plain

from pneumo_ros.control import LAWS, Law, Machine, Measurement, Setpoint, ValveInverse
from pneumo_ros.control.motion import Trajectory, Waypoint
from pneumo_ros.couple.mujoco import Cylinders, Mount
from pneumo_ros.plant import Model, load_model

STEP, SAMPLE = 2e-4, 1e-3  # s
WAY = ((0.0, -0.08), (0.5, -0.08), (1.7, 0.08), (2.2, 0.08), (3.4, -0.08))  # s, m, again and again
GAINS = {
    "cascade": {"damping": 4000.0, "force_rate": 90.0, "position_rate": 25.0},
    "pva": {"proportional": 60.0, "derivative": 20.0},
    "sliding_mode": {},
}  # fmt: skip


def known(machine: Model) -> dict[str, Machine]:
    """What a law knows: the arm by its URDF, and what it has at mid stroke."""
    plain = machine.with_effects([*(n for n in machine.effects if n != "arm_load"), "constant_load"])
    middle = machine.outputs(machine.state()[None])
    load = float(middle["force"][0]) - middle_plain(plain.with_parameters({"constant_load.load": 0.0}))
    mass = machine["piston.mass"] + float(middle["added_mass"][0])
    fixed = plain.with_parameters({"piston.mass": mass, "constant_load.load": load})
    return {
        "mass and weight at mid stroke": Machine.of(fixed.effects, fixed.parameters),
        "arm_load": Machine.of(machine.effects, machine.parameters),
    }


def follow(machine: Model, law: Law, seconds: float) -> np.ndarray:
    """Errors (samples,) of the rod [m] in MuJoCo."""
    arm, data = boom(machine["piston.mass"])
    arm.opt.timestep = STEP
    cylinders = Cylinders(arm, data, {"lift": Mount(machine, tendon="cylinder", length=LENGTH)}, step=STEP)
    one, rng = cylinders.by_name["lift"], np.random.default_rng(1)
    period = WAY[-1][0]
    points = [Waypoint(k * period + t, y, 0.0, 0.0) for k in range(int(seconds / period) + 1) for t, y in WAY[1:]]
    start = one.position
    way = Trajectory(Setpoint(start), 0.0, [Waypoint(1.5, WAY[0][1], 0.0, 0.0), *shifted(points, 1.5)])
    load, p_b = float(machine.outputs(machine.state(y=start)[None])["force"][0]), 3e5
    one.cylinder.pressurise((load + machine["piston.area_b"] * p_b) / machine["piston.area_a"], p_b)
    errors = []
    while data.time < seconds:
        mujoco.mj_fwdPosition(arm, data)
        position, setpoint = float(data.ten_length[0]) - LENGTH, way(data.time)
        errors.append(setpoint.position - position)
        noisy = [p + NOISE_P * rng.normal() for p in one.cylinder.pressures]
        seen = Measurement(data.time, position + NOISE_Y * rng.normal(), None, *noisy)
        volts = law.step(setpoint, seen)
        for _ in range(round(SAMPLE / STEP)):
            cylinders.step({"lift": volts})
    return np.array(errors)


def shifted(points: "list[Waypoint]", by: float) -> "list[Waypoint]":
    """The same way, `by` [s] later."""
    return [one._replace(time=one.time + by) for one in points]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=12.0, help="length of each run")
    options = parser.parse_args()
    machine = load_model(ARM / "lever.yaml")
    print("| law | knows of the arm | error rms | largest |\n|---|---|---|---|")
    for name, gains in GAINS.items():
        for what, one in known(machine).items():
            law = LAWS[name](gains, ValveInverse(0.78, 0.78), one)
            late = 1e3 * follow(machine, law, options.seconds)[round(2.0 / SAMPLE) :]
            print(f"| {name} | {what} | {np.sqrt(np.mean(late**2)):.2f} mm | {np.abs(late).max():.2f} mm |", flush=True)


if __name__ == "__main__":
    main()
