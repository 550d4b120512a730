"""Recordings of a rotary vane actuator by the second simulator, whose equations know no unit: m are rad, N are N m."""

from pathlib import Path

import numpy as np
from rig import bags, loop, sensors
from rig.machine import SMOOTH, Machine

from pneumo_ros.plant import load_model

VANE = load_model("vane")
RIG = Machine(
    mass=VANE["piston.mass"], area_a=VANE["piston.area_a"], area_b=VANE["piston.area_b"],
    half_stroke=0.5 * VANE["piston.stroke"], volume_a=VANE["rotary_vane.volume_a"],
    volume_b=VANE["rotary_vane.volume_b"], fill=VANE["arctan_flow.filling_coefficient"],
    exhaust=VANE["arctan_flow.exhaust_coefficient"], static=VANE["lugre_friction.static_friction"],
    coulomb=VANE["lugre_friction.coulomb_friction"], stribeck=VANE["lugre_friction.stribeck_velocity"],
    bristle=VANE["lugre_friction.bristle_stiffness"], bristle_damping=VANE["lugre_friction.bristle_damping"], drag=0.0,
)  # fmt: skip
INPUTS = ((2.0, 0.5), (3.0, 0.4), (1.6, 0.8), (2.5, 1.0))  # V, Hz of sines
BEGIN = 1767225600 * 10**9  # ns since 1970


def turn(voltage: np.ndarray, **hidden: float) -> tuple[Machine, np.ndarray]:
    """The vane with what is `hidden`, and its states at the start of each millisecond."""
    machine = RIG._replace(**hidden)
    return machine, loop.run(machine, SMOOTH, loop.rest(machine, 0.0, 3e5), voltage)[0]


def record(folder: Path, number: int, seconds: float = 6.0, **hidden: float) -> Path:
    """A recording with the usual noise: 5e-6 rad and 300 Pa."""
    size, frequency = INPUTS[number]
    voltage = size * np.cos(2.0 * np.pi * frequency * 1e-3 * np.arange(round(1e3 * seconds)))
    machine, states = turn(voltage, **hidden)
    random = np.random.default_rng([11, number])
    noise = sensors.position_noise(random, len(states))
    path = folder / f"run_{number}"
    bags.write(path, sensors.record(path.name, machine, states, voltage, noise, random), BEGIN)
    return path
