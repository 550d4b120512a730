"""The models of the paper's figures: before identification, identified, and without friction dynamics."""

from typing import Any

import pneumo_ros as pn
from pneumo_ros.plant.effect import exp, tanh

WRONG = {  # shares by which a machine file is off before anything is identified
    "lugre_friction.static_friction": 0.85, "lugre_friction.coulomb_friction": 1.1,
    "lugre_friction.stribeck_velocity": 1.3, "quadratic_drag.coefficient": 1.2, "lugre_friction.bristle_stiffness": 0.7,
}  # fmt: skip
FRICTION = ("lugre_friction", "quadratic_drag")


class StaticFriction(pn.Effect):
    """The static map alone, Eq. 12 with the drag of Eq. 10: a force of the velocity, without bristles."""

    static_friction = pn.Parameter(100.0, "N", "static friction force F_s", low=0.0)
    coulomb_friction = pn.Parameter(70.0, "N", "Coulomb friction force F_c", low=0.0)
    stribeck_velocity = pn.Parameter(0.01, "m/s", "Stribeck velocity v_s", low=1e-6)
    drag = pn.Parameter(4546.7, "N s2/m2", "drag coefficient C_d", low=0.0)
    zero_width = pn.Parameter(2e-3, "m/s", "speed over which the force changes its sign", low=1e-6)

    def equations(v, static_friction, coulomb_friction, stribeck_velocity, drag, zero_width):  # type: ignore[override,no-untyped-def]  # noqa: N805
        level = coulomb_friction + (static_friction - coulomb_friction) * exp(-((v / stribeck_velocity) ** 2))
        friction = level * tanh(v / zero_width) + drag * v * abs(v)
        return friction  # noqa: RET504


def before(name: str) -> pn.Model:
    """The shipped machine `name`, its friction off by 10 to 30 %, as before an identification."""
    machine = pn.load_model(name)
    return machine.with_parameters({key: share * machine[key] for key, share in WRONG.items()})


def without_friction(model: pn.Model) -> pn.Model:
    """The machine without friction: F_atr = 0 in Eq. 2."""
    return model.with_effects([name for name in model.effects if name not in FRICTION])


def without_bristles(model: pn.Model) -> pn.Model:
    """The machine with its static map as a force of the velocity alone."""
    keys = {key: f"lugre_friction.{key}" for key in ("static_friction", "coulomb_friction", "stribeck_velocity")}
    values = {key: model[name] for key, name in keys.items()} | {"drag": model["quadratic_drag.coefficient"]}
    own: Any = pn.load_model("axis", effects_files=[StaticFriction])
    plain = {name: value for name, value in model.parameters.items() if not name.startswith(FRICTION)}
    kept = [name for name in model.effects if name not in FRICTION]
    bare = own.with_effects([*kept, "static_friction"], {f"static_friction.{key}": one for key, one in values.items()})
    return bare.with_parameters(plain)
