"""True values of catalogue parameters, from the rig's fields of the same meaning."""

from collections.abc import Callable, Mapping
from math import pi, sqrt
from typing import Any

Fields = Mapping[str, float]
Truths = dict[str, Callable[[Fields], float]]
NEW_VOLUMES = {"volume_a": 5.1e-4, "volume_b": 4.0e-4}  # m3, of the machine file


def _load_frequency(m: Fields) -> float:
    return sqrt(m["coupling"] / _hanging(m)) / (2.0 * pi)


def _hanging(m: Fields) -> float:
    return m["load_share"] * (m["mass"] + m["payload"])


def _tank_time(m: Fields) -> float:
    return m["tank"] * m["feed"] / (m["adiabatic"] * m["gas_constant"] * m["temperature"])


_DROOP: Truths = {"resistance_supply": lambda m: m["feed"], "time_constant": _tank_time}
_LEAKS: Truths = {"conductance_a": lambda m: m["leak_a"], "conductance_b": lambda m: m["leak_b"]}

# By the rig's name of the shape. Other shapes have another equation than the catalogue; only names can be compared.
TRUE: dict[str, Truths] = {
    "viscous_friction": {"coefficient": lambda m: m["viscous_out"]},
    "asymmetric_friction": {"ratio": lambda m: m["retract_excess"]},
    "asymmetric_viscous_friction": {
        "coefficient_extension": lambda m: m["viscous_out"],
        "coefficient_retraction": lambda m: m["viscous_in"],
    },
    "pressure_dependent_friction": {"coefficient": lambda m: m["seal"]},
    "stribeck_shape": {"exponent": lambda m: m["stribeck_power"]},
    "stribeck_shape:rational": {
        "exponent": lambda m: m["stribeck_power"],
        "rational": lambda m: m["stribeck_rational"],
    },
    "friction_warmup": {"share": lambda m: m["warm_share"], "time_constant": lambda m: m["warm_fast"]},
    "friction_lag:film": {"time_constant": lambda m: m["lag_film"]},
    "payload_mass": {"mass_added": lambda m: m["payload"]},
    "constant_load": {"load": lambda m: m["load"]},
    "spring_load": {"stiffness": lambda m: m["spring"], "rest_position": lambda m: m["spring_centre"]},
    "spring_load:hardening": {
        "stiffness": lambda m: m["spring"],
        "hardening": lambda m: m["spring_hardening"] / 0.3**2,
    },
    "spring_load:progressive": {
        "stiffness": lambda m: m["spring"],
        "progression": lambda m: m["spring_hardening"] / 0.3,
    },
    "load_compliance": {
        "load_share": lambda m: m["load_share"],
        "frequency": _load_frequency,
        "damping_ratio": lambda m: 0.5 * m["coupling_damping"] / sqrt(m["coupling"] * _hanging(m)),
    },
    "backlash": {"gap": lambda m: 2.0 * m["encoder_play"]},
    "choked_flow": {
        "conductance_filling": lambda m: m["sonic_conductance"],
        "conductance_exhaust": lambda m: m["sonic_conductance"] * m["exhaust"] / m["fill"],
        "critical_ratio": lambda m: m["critical_ratio"],
    },
    "valve_spool_dynamics": {
        "angular_frequency": lambda m: m["spool_rate"],
        "damping_ratio": lambda m: m["spool_damping"],
    },
    "valve_null_offset": {"offset": lambda m: m["null_offset"]},
    "valve_hysteresis": {"half_width": lambda m: m["play"]},
    "supply_pressure_droop": _DROOP,
    "supply_pressure_droop:line": _DROOP,
    "line_delay": {"delay": lambda m: m["line_delay"], "loss_pressure": lambda m: m["line_loss"]},
    "cross_piston_leakage": {"conductance": lambda m: m["cross"]},
    "leakage_to_atmosphere": _LEAKS,
    "leakage_to_atmosphere:both": _LEAKS,
    "heat_exchange:polytropic": {"share": lambda m: (1.4 - m["adiabatic"]) / 0.4},
    "dead_volume": {
        "volume_added_a": lambda m: m["volume_a"] - NEW_VOLUMES["volume_a"],
        "volume_added_b": lambda m: m["volume_b"] - NEW_VOLUMES["volume_b"],
    },
    "pressure_sensor_offset": {"offset_a": lambda m: m["offset_a"], "offset_b": lambda m: m["offset_b"]},
    "pressure_sensor_gain": {"error_a": lambda m: m["gain_a"], "error_b": lambda m: m["gain_b"]},
    "position_sensor_delay": {"delay": lambda m: m["position_delay"]},
}


def true_parameters(truth: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """True values of a case by catalogue effect and parameter; effects with another equation are left out."""
    machine = truth["machine"]
    return {
        hidden["effect"]: {key: float(value(machine)) for key, value in TRUE[hidden["shape"]].items()}
        for hidden in truth["effects"]
        if hidden["same_shape"] and hidden["shape"] in TRUE
    }
