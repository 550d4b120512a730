"""Effects in valve, supply, lines, chambers and sensors."""

from .effect import Effect, Fields, Rng, either, field, fixed, inverse, towards
from .machine import Machine

_CHAMBERS = ("chamber_a", "chamber_b")
_VALVE = ("valve", *_CHAMBERS)
_TYPICAL_FLOW = 5.7e-4  # kg/s, flow of steady motion at full opening


def _choked(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"sonic": 1.0, "sonic_conductance": size, "critical_ratio": rng.uniform(0.2, 0.4)}


def _mixed(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"sonic": size, "sonic_conductance": 5e-9, "critical_ratio": 0.25, "subsonic_index": 0.6}


def _spool(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"spool_rate": size, "spool_damping": rng.uniform(0.6, 0.95)}


def _droop(machine: Machine, size: float, rng: Rng) -> Fields:
    return {"feed": size / _TYPICAL_FLOW, "tank": rng.uniform(2e-4, 2e-3)}


def _long_feed(machine: Machine, size: float, rng: Rng) -> Fields:
    return {**_droop(machine, size, rng), "tank": rng.uniform(2e-5, 1e-4)}


def _tube(machine: Machine, size: float, rng: Rng) -> Fields:
    """A laminar tube with a sound travel time of `size` s, after Richer and Hurmuzlu."""
    viscosity, bore = 1.81e-5, rng.uniform(4e-3, 6e-3)
    loss = 0.5 * 32.0 * viscosity / bore**2 * machine.gas_constant * machine.temperature * size
    return {"line_delay": size, "line_loss": loss}


def _dead(machine: Machine, size: float, rng: Rng) -> Fields:
    which = rng.choice(["volume_a", "volume_b", "both"])
    names = ("volume_a", "volume_b") if which == "both" else (str(which),)
    return {name: getattr(machine, name) + size for name in names}


VALVE = {
    "choked_flow": Effect("m3/(s Pa)", 4e-9, 6e-9, _VALVE, _choked, weaken=lambda size, scale: size),
    "choked_flow:mixed": Effect("1", 0.3, 1.0, _VALVE, _mixed, same_shape=False),
    "valve_spool_dynamics": Effect("rad/s", 50.0, 110.0, _VALVE, _spool, weaken=inverse),
    "valve_spool_dynamics:first": Effect("s", 7e-3, 2e-2, _VALVE, field("spool_lag")),
    "valve_spool_dynamics:slew": Effect(
        "V/s", 25.0, 80.0, _VALVE, fixed("spool_slew", spool_lag=2e-3), same_shape=False, weaken=inverse
    ),
    "valve_null_offset": Effect("V", 0.05, 0.3, _VALVE, field("null_offset"), signed=True),
    "valve_hysteresis": Effect("V", 0.05, 0.2, _VALVE, field("play")),
    "valve_hysteresis:preisach": Effect("V", 0.05, 0.2, _VALVE, fixed("play", play_spread=1.0), same_shape=False),
    "valve_internal_leakage": Effect("kg/s", 5e-6, 3e-5, _VALVE, field("sneak"), same_shape=False),
    "supply_pressure_droop": Effect("Pa", 2e4, 1e5, _VALVE, _droop),
    "supply_pressure_droop:line": Effect("Pa", 2e4, 1e5, _VALVE, _long_feed),
    "line_delay": Effect("s", 6e-3, 1.5e-2, _VALVE, _tube),
    "line_delay:volume": Effect("s", 6e-3, 1.5e-2, _VALVE, field("line_lag"), same_shape=False),
}

GAS = {
    "cushioning": Effect("1", 0.01, 0.1, _CHAMBERS, fixed("cushion", cushion_length=0.025), same_shape=False),
    "cross_piston_leakage": Effect("kg/(s Pa)", 1e-10, 1e-9, _CHAMBERS, field("cross")),
    "cross_piston_leakage:gap": Effect("kg/(s Pa)", 1e-10, 1e-9, _CHAMBERS, field("cross_gap"), same_shape=False),
    "cross_piston_leakage:orifice": Effect(
        "kg/(s Pa)", 1e-10, 1e-9, _CHAMBERS, field("cross_orifice"), same_shape=False
    ),
    "leakage_to_atmosphere": Effect("kg/(s Pa)", 1e-10, 1e-9, _CHAMBERS, either("leak_a", "leak_b")),
    "leakage_to_atmosphere:both": Effect("kg/(s Pa)", 1e-10, 1e-9, _CHAMBERS, field("leak_a", "leak_b")),
    "leakage_to_atmosphere:gap": Effect(
        "kg/(s Pa)", 1e-10, 1e-9, _CHAMBERS, either("leak_gap_a", "leak_gap_b"), same_shape=False
    ),
    "dead_volume": Effect("m3", 5e-5, 3e-4, _CHAMBERS, _dead),
    "heat_exchange": Effect("s", 0.1, 0.5, _CHAMBERS, field("wall_time"), same_shape=False, weaken=inverse),
    "heat_exchange:polytropic": Effect("1", 1.1, 1.25, _CHAMBERS, field("adiabatic"), weaken=towards(1.4)),
}

SENSORS = {
    "pressure_sensor_offset": Effect("Pa", 5e3, 2e4, ("sensor",), either("offset_a", "offset_b"), signed=True),
    "pressure_sensor_gain": Effect("1", 0.01, 0.03, ("sensor",), either("gain_a", "gain_b"), signed=True),
    "position_sensor_delay": Effect("s", 4e-3, 2e-2, ("sensor",), field("position_delay")),
    "position_sensor_delay:filter": Effect("s", 4e-3, 2e-2, ("sensor",), field("position_filter"), same_shape=False),
}
