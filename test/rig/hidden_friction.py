"""Effects in the momentum equation."""

import numpy as np

from .effect import Effect, Fields, Rng, field, fixed, inverse, towards
from .machine import Machine

_MOMENTUM = ("momentum",)


def _viscous(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"viscous_out": machine.viscous_out + size, "viscous_in": machine.viscous_in + size}


def _sublinear(machine: Machine, size: float, rng: Rng) -> Fields:
    return {**_viscous(machine, size, rng), "viscous_power": rng.uniform(0.6, 0.85)}


def _one_sided(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"viscous_out": machine.viscous_out + 0.3 * size, "viscous_in": machine.viscous_in + size}


def _warming(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"warm_share": size, "warm_fast": rng.uniform(4.0, 15.0)}


def _spot(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"spot_height": size, "spot_centre": rng.uniform(-0.25, 0.3), "spot_width": rng.uniform(0.03, 0.12)}


def _spring(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"spring": size, "spring_centre": rng.uniform(-0.1, 0.1)}


def _coupled(machine: Machine, hertz: float, rng: Rng) -> Fields:
    share, omega = rng.uniform(0.3, 0.6), 2.0 * np.pi * hertz
    hanging = share * (machine.mass + machine.payload)
    damping = 2.0 * rng.uniform(0.03, 0.1) * omega * hanging
    return {"load_share": share, "coupling": hanging * omega**2, "coupling_damping": damping}


def _loose(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"load_share": 0.5, "coupling": 5e5, "coupling_damping": 300.0, "coupling_gap": size}


def _rested(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"rest_rise": size, "rest_time": 10.0 ** rng.uniform(-0.7, 0.5), "rest_power": rng.uniform(0.5, 0.8)}


FRICTION = {
    "viscous_friction": Effect("N s/m", 80.0, 300.0, _MOMENTUM, _viscous),
    "viscous_friction:power": Effect("N s/m", 80.0, 300.0, _MOMENTUM, _sublinear, same_shape=False),
    "asymmetric_friction": Effect("1", 0.1, 0.4, _MOMENTUM, field("retract_excess"), signed=True),
    "asymmetric_friction:coulomb": Effect(
        "1", 0.1, 0.4, _MOMENTUM, fixed("retract_excess", retract_static=0.0), same_shape=False, signed=True
    ),
    "asymmetric_viscous_friction": Effect("N s/m", 60.0, 150.0, _MOMENTUM, _one_sided),
    "position_dependent_friction": Effect("1", 0.15, 0.6, _MOMENTUM, _spot, same_shape=False),
    "position_dependent_friction:bow": Effect("1", 0.08, 0.25, _MOMENTUM, field("bow"), same_shape=False),
    "pressure_dependent_friction": Effect("N/Pa", 3e-5, 1e-4, _MOMENTUM, field("seal")),
    "pressure_dependent_friction:lips": Effect(
        "N/Pa", 3e-5, 1e-4, _MOMENTUM, fixed("seal", seal_power=0.8), same_shape=False
    ),
    "stribeck_shape": Effect("1", 0.5, 1.0, _MOMENTUM, field("stribeck_power"), weaken=towards(2.0)),
    "stribeck_shape:rational": Effect("1", 0.6, 1.0, _MOMENTUM, field("stribeck_rational")),
    "friction_warmup": Effect("1", 0.15, 0.4, _MOMENTUM, _warming),
    "friction_warmup:two_rates": Effect(
        "1", 0.15, 0.4, _MOMENTUM, fixed("warm_share", warm_fast=4.0, warm_slow=25.0, warm_split=0.6), same_shape=False
    ),
    "friction_warmup:work": Effect("1", 0.15, 0.4, _MOMENTUM, fixed("warm_work", warm_fast=10.0), same_shape=False),
    "dwell_time_breakaway": Effect("N", 15.0, 40.0, _MOMENTUM, _rested, same_shape=False),
    "dwell_time_breakaway:logarithm": Effect(
        "N", 15.0, 40.0, _MOMENTUM, fixed("rest_rise", rest_log=1.0, rest_time=0.05), same_shape=False
    ),
    "friction_lag": Effect("s", 3e-3, 1e-2, _MOMENTUM, field("lag_delay"), same_shape=False),
    "friction_lag:film": Effect("s", 3e-3, 1e-2, _MOMENTUM, field("lag_film")),
}

LOADS = {
    "payload_mass": Effect("kg", 3.0, 20.0, _MOMENTUM, field("payload")),
    "constant_load": Effect("N", 15.0, 50.0, _MOMENTUM, field("load"), signed=True),
    "spring_load": Effect("N/m", 40.0, 150.0, _MOMENTUM, _spring),
    "spring_load:hardening": Effect("N/m", 40.0, 100.0, _MOMENTUM, fixed("spring", spring_hardening=0.3)),
    "spring_load:progressive": Effect(
        "N/m", 40.0, 100.0, _MOMENTUM, fixed("spring", spring_hardening=0.5, spring_power=1.0)
    ),
    "load_compliance": Effect("Hz", 5.0, 25.0, _MOMENTUM, _coupled, weaken=inverse),
    "backlash": Effect("m", 5e-5, 5e-4, ("sensor", "momentum"), field("encoder_play")),
    "backlash:load": Effect("m", 1e-4, 5e-4, _MOMENTUM, _loose, same_shape=False),
}
