"""A cylinder on an arm of MuJoCo: the error of large steps, with the force of the step's begin and with the arm's mass.

Usage: python benchmarks/bench_coupling.py

Two links, a 32/12 cylinder on a tendon over the first joint, valve voltage a sine of 3 V and 0.7 Hz, cascade off. The
reference takes steps of 20 us. Error: rms of the rod's position over 4 s. Chatter: rms of the rod's velocity minus that
of the reference, both held to the larger step's times. Time: of a cylinder's step, and of the whole step of MuJoCo.
"""

import math
import time

import mujoco
import numpy as np

from pneumo_ros.couple import Cylinder
from pneumo_ros.couple.mujoco import Cylinders, Mount
from pneumo_ros.errors import NumericalError
from pneumo_ros.plant import Model, load_model

ARM = """<mujoco><option timestep="{step}" integrator="implicitfast"/><worldbody>
<site name="base" pos="0.05 0 0.55"/>
<body pos="0 0 1"><joint name="shoulder" type="hinge" axis="0 1 0" damping="0.5"/>
<geom type="capsule" fromto="0 0 0 0.7 0 0" size="0.03" mass="{first}"/><site name="clevis" pos="0.3 0 -0.04"/>
<body pos="0.7 0 0"><joint name="elbow" type="hinge" axis="0 1 0" damping="0.5" stiffness="200"/>
<geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.025" mass="{second}"/></body></body>
</worldbody><tendon><spatial name="lift"><site site="base"/><site site="clevis"/></spatial></tendon></mujoco>"""
ARMS = {"heavy": (8.0, 4.0), "light": (1.0, 0.5)}  # kg of the links
SECONDS, FINEST = 4.0, 2e-5
STEPS = (1e-3, 2e-3, 1e-2)
VOLTS, HERTZ = 3.0, 0.7
RUNS, MOVES = 1000, 100  # of the test of passivity, and steps in each
STIFF = 1e6  # kg: a mass that takes no notice of the force, so that the force is that of the motion as it was


def machine() -> Model:
    """The default machine with the chambers of a 32/12 cylinder of 300 mm."""
    bore, rod = math.pi / 4.0 * 0.032**2, math.pi / 4.0 * 0.012**2
    return load_model("axis").with_parameters(
        {
            "piston.area_a": bore, "piston.area_b": bore - rod, "piston.stroke": 0.3,
            "chambers.volume_a": bore * 0.15 + 2e-5, "chambers.volume_b": (bore - rod) * 0.15 + 2e-5,
        }
    )  # fmt: skip


def run(arm: tuple[float, float], step: float, explicit: bool) -> tuple[np.ndarray, np.ndarray, float]:
    """Rod positions [m] and velocities [m/s] at each step, and the time of a cylinder's step [s]."""
    model = mujoco.MjModel.from_xml_string(ARM.format(step=step, first=arm[0], second=arm[1]))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    length = float(data.ten_length[0])
    cylinders = Cylinders(model, data, {"lift": Mount(machine(), tendon="lift", length=length)})
    one = cylinders.by_name["lift"]
    one.cylinder.pressurise(5.5e5, 3.0e5)  # about what carries the arm
    whole, spent = one.cylinder.step, 0.0

    def stepped(y: float, v: float, mass: float, free: float, dt: float, volts: float) -> float:
        nonlocal spent
        begin = time.perf_counter()
        force = whole(y, v, STIFF, 0.0, dt, volts) if explicit else whole(y, v, mass, free, dt, volts)
        spent += time.perf_counter() - begin
        return force

    one.cylinder.step = stepped  # type: ignore[method-assign]
    count = round(SECONDS / step)
    positions, velocities = np.empty(count), np.empty(count)
    for k in range(count):
        cylinders.step({"lift": VOLTS * math.sin(2.0 * math.pi * HERTZ * k * step)})
        positions[k], velocities[k] = one.position, one.velocity
    return positions, velocities, spent / count


def passivity() -> tuple[float, float]:
    """Largest gain of energy [J] in random runs with the valve closed, and the median energy at their start.

    Random are the mass (0.3 to 100 kg), step (0.5 to 10 ms), position, velocity and both pressures.
    """
    random, one, gains, starts = np.random.default_rng(7), Cylinder(load_model("axis")), [0.0], []
    for _ in range(RUNS):
        mass, dt = 10.0 ** random.uniform(-0.5, 2.0), 10.0 ** random.uniform(-3.3, -2.0)
        position, velocity = random.uniform(-0.5, 0.5), random.uniform(-1.0, 1.0)
        one.reset(position)
        one.pressurise(*random.uniform(1e5, 7e5, 2))
        starts.append(one.energy() + 0.5 * mass * velocity**2)
        for _ in range(MOVES):
            velocity += dt * one.step(position, velocity, mass, 0.0, dt, 0.0) / mass
            position += dt * velocity
            if abs(position) > 0.9:  # m: before the end of the stroke, which MuJoCo's contact would hold
                break
            one.follow(position)
            gains.append(one.energy() + 0.5 * mass * velocity**2 - starts[-1])
    return max(gains), float(np.median(starts))


def main() -> None:
    """Print the table."""
    print("| arm | step | force | rms error | chatter | cylinder's step |")
    print("|---|---|---|---|---|---|")
    for name, arm in ARMS.items():
        exact, speed, _ = run(arm, FINEST, explicit=False)
        for step in STEPS:
            every = round(step / FINEST)
            for explicit in (True, False):
                row = f"| {name} | {1e3 * step:g} ms | {'explicit' if explicit else 'with effective mass'} |"
                try:
                    y, v, cost = run(arm, step, explicit)
                except NumericalError:
                    print(f"{row} diverges | | |")
                    continue
                error = 1e3 * math.sqrt(float(np.mean((y - exact[::every][: len(y)]) ** 2)))
                chatter = 1e3 * math.sqrt(float(np.mean((v - speed[::every][: len(v)]) ** 2)))
                print(f"{row} {error:.3g} mm | {chatter:.3g} mm/s | {1e6 * cost:.1f} us |")
    gained, held = passivity()
    print(
        f"\nValve closed, {RUNS} random runs of {MOVES} steps: gas and motion together gain at most "
        f"{1e3 * gained:.2g} mJ of {held:.0f} J that the gas holds in the median."
    )


if __name__ == "__main__":
    main()
