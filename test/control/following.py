"""Laws on the default machine and others, with sensors as noisy as a rig's."""

from pneumo_ros.control import LAWS, Law, Machine, Record, Reference, closed_loop
from pneumo_ros.control.sensors import NoisySensors
from pneumo_ros.plant import Model, Stepper, load_model

AXIS = load_model("axis")
FRICTION = ("lugre_friction.static_friction", "lugre_friction.coulomb_friction")
STICKY = AXIS.with_parameters({name: 1.2 * AXIS[name] for name in FRICTION})
LOADED = AXIS.with_effects([*AXIS.effects, "constant_load"], {"constant_load.load": 40.0})


def law_for(name: str, known: Model = AXIS, **gains: float) -> Law:
    """A law that knows a machine."""
    return LAWS[name](gains, machine=Machine.of(known.effects, known.parameters))


def follow(law: Law, reference: Reference, seconds: float, plant: Model = AXIS, seed: int = 0) -> Record:
    """A run at 1 kHz from rest at the reference."""
    stepper = Stepper(plant, plant.state(y=reference(0.0).position, p_a=3e5, p_b=3.7e5), sample_time=1e-3)
    return closed_loop(stepper, law, reference, round(seconds * 1e3), NoisySensors(seed=seed))
