"""Plants and motions of the control benchmark."""

from pathlib import Path

import numpy as np

from pneumo_ros.command.rated_motions import SAMPLE_TIME, stepper
from pneumo_ros.control import Law, Measurement, Record, Reference, closed_loop
from pneumo_ros.control.control_file import load_control
from pneumo_ros.control.reference import moves, sine
from pneumo_ros.control.sensors import NoisySensors
from pneumo_ros.plant import Model, load_model

NOISE_POSITION, NOISE_PRESSURE = 1e-5, 300.0  # m, Pa
AXIS = load_model("axis")
HERE = Path(__file__).parent
SINE, SINE_SECONDS, SINE_BEGIN = sine(0.3, 0.05), 45.0, 5.0
HOLD, STEP, STEADY = 20.0, 0.06, 3e-4  # s, m, m
LEVELS = (0.0, STEP, 0.0, -STEP, 0.0)
STEPS = moves(LEVELS, HOLD, 1.0)


def with_effect(effect: str, **values: float) -> Model:
    """The default machine with one more effect."""
    return AXIS.with_effects([*AXIS.effects, effect], {f"{effect}.{name}": value for name, value in values.items()})


FRICTION = ("lugre_friction.static_friction", "lugre_friction.coulomb_friction")
PLANTS = {
    "nominal": AXIS,
    "10 kg payload": with_effect("payload_mass", mass_added=10.0),
    "viscous friction": with_effect("viscous_friction", coefficient=100.0),
    "choked flow": with_effect("choked_flow"),
    "spool dynamics": with_effect("valve_spool_dynamics"),
    "cross-piston leakage": with_effect("cross_piston_leakage"),
    "20 % more friction": AXIS.with_parameters({name: 1.2 * AXIS[name] for name in FRICTION}),
}


def shipped(law: str, known: Model = AXIS) -> Law:
    """The law with the package's gains, based on the machine `known`."""
    return load_control(law).make(known.effects, known.parameters)


def own(file: str, known: Model) -> Law:
    """The law with the gains of a control file beside this one."""
    return load_control(HERE / file).make(known.effects, known.parameters)


def follow(
    plant: Model, law: Law, reference: Reference, seconds: float, seed: int = 0, noisy: bool = True
) -> tuple[Record, np.ndarray]:
    """The run, and its sensor signals: time, position, pressures (samples, 4)."""
    sensors = NoisySensors(NOISE_POSITION * noisy, NOISE_PRESSURE * noisy, seed)
    shown: list[tuple[float, ...]] = []

    def sensor(time: float, state: np.ndarray) -> Measurement:
        seen = sensors(time, state)
        shown.append((seen.time, seen.position, seen.pressure_a or 0.0, seen.pressure_b or 0.0))
        return seen

    law.reset()
    start = stepper(plant, reference(0.0).position)
    record = closed_loop(start, law, reference, round(seconds / SAMPLE_TIME), sensor)
    return record, np.array(shown)
