"""The one table of signals through which effects act on each other.

Frames and signs: positive `y` extends the rod and grows chamber a. Forces are positive when they oppose positive
velocity. Mass flows are positive INTO the chamber they are named after. Pressures are absolute.

Kinds: an *input* comes from outside; a *measured* signal does too, in machines without a state of that name, and only
where an effect reads it; contributions to a *sum* add, those to a *product* multiply; a *single* has one source or its
default, and any number of effects may read and rewrite it, in the order of the effects list.
"""

from dataclasses import dataclass
from typing import Literal

from pneumo_ros.measured import MEASURED

Kind = Literal["input", "measured", "sum", "product", "single"]


@dataclass(frozen=True)
class Signal:
    """One row: name as it stands in equations, kind, unit, default (a number or an expression) and meaning.

    `without`: the default of a machine that lacks a parameter in `default`; empty where it must have it. `measured`:
    the default where the measured signals in it are asked for as inputs; empty where there are none.
    """

    name: str
    kind: Kind
    unit: str
    default: str
    meaning: str
    without: str = ""
    measured: str = ""


_TABLE = (
    # inputs
    Signal("U", "input", "V", "0.0", "valve voltage, held over a sample"),
    Signal("U_b", "measured", "V", "0.0", "voltage of the valve of chamber b, where each chamber has one"),
    Signal("t", "input", "s", "0.0", "time since the start"),
    Signal(
        "p_a", "measured", "Pa", "0.0", "measured pressure in chamber a, absolute; a state where there are chambers"
    ),
    Signal(
        "p_b", "measured", "Pa", "0.0", "measured pressure in chamber b, absolute; a state where there are chambers"
    ),
    Signal("imposed_velocity", "measured", "m/s", "0.0", "velocity at which a test machine moves the piston"),
    *(Signal(one.input, "measured", one.unit, "0.0", one.meaning) for one in MEASURED),
    # valve
    Signal("voltage_offset", "sum", "V", "0.0", "added to the valve voltage before anything else"),
    Signal("voltage", "single", "V", "U + voltage_offset", "voltage at the valve coil"),
    Signal("spool", "single", "V", "voltage", "spool position, in volts of command"),
    Signal("opening", "single", "V", "spool", "spool position beyond the dead zone"),
    Signal("asked_a", "single", "V", "opening", "opening that the command asks of port a; above 0 it fills chamber a"),
    Signal("asked_b", "single", "V", "-opening", "opening that the command asks of port b; above 0 it fills chamber b"),
    Signal("opening_a", "single", "V", "asked_a", "opening at port a: above 0 it fills chamber a, below it empties it"),
    Signal("opening_b", "single", "V", "asked_b", "opening at port b: above 0 it fills chamber b, below it empties it"),
    Signal("share_pa", "product", "1", "1.0", "multiplies the flow of path P-A, supply to chamber a"),
    Signal("share_at", "product", "1", "1.0", "multiplies the flow of path A-T, chamber a to exhaust"),
    Signal("share_pb", "product", "1", "1.0", "multiplies the flow of path P-B, supply to chamber b"),
    Signal("share_bt", "product", "1", "1.0", "multiplies the flow of path B-T, chamber b to exhaust"),
    Signal("ratio_pa", "single", "1", "critical_ratio", "critical pressure ratio of path P-A"),
    Signal("ratio_at", "single", "1", "critical_ratio", "critical pressure ratio of path A-T"),
    Signal("ratio_pb", "single", "1", "critical_ratio", "critical pressure ratio of path P-B"),
    Signal("ratio_bt", "single", "1", "critical_ratio", "critical pressure ratio of path B-T"),
    Signal("subsonic_power", "single", "1", "0.5", "subsonic index m of all paths"),
    Signal("supply_drop", "sum", "Pa", "0.0", "pressure lost between supply and valve"),
    Signal(
        "p_s",
        "single",
        "Pa",
        "supply_pressure - supply_drop",
        "supply pressure at the valve, absolute",
        measured="measured_supply - supply_drop",
    ),
    Signal("p_atm", "single", "Pa", "atmospheric_pressure", "pressure of the atmosphere, absolute", "101325.0"),
    Signal("valve_flow_a", "sum", "kg/s", "0.0", "mass flow from the valve into the line of chamber a"),
    Signal("valve_flow_b", "sum", "kg/s", "0.0", "mass flow from the valve into the line of chamber b"),
    # position loop and motor
    Signal("position_gain", "single", "1/m", "proportional_gain", "gain of the position loop", measured="loop_gain"),
    Signal("duty", "single", "1", "0.0", "share of its voltage that the driver gives the motor, -1 to 1"),
    Signal("voltage_drop", "sum", "V", "0.0", "voltage lost between source and driver"),
    Signal(
        "driver_voltage",
        "single",
        "V",
        "source_voltage - voltage_drop",
        "voltage at the driver of the motor",
        measured="measured_voltage - voltage_drop",
    ),
    Signal("powered", "single", "1", "1.0", "whether the driver is on, 1 or 0", measured="motor_on"),
    # lines and chambers
    Signal("port_flow_a", "single", "kg/s", "valve_flow_a", "mass flow through port a into chamber a"),
    Signal("port_flow_b", "single", "kg/s", "valve_flow_b", "mass flow through port b into chamber b"),
    Signal("flow_a", "sum", "kg/s", "0.0", "further mass flow into chamber a (leaks)"),
    Signal("flow_b", "sum", "kg/s", "0.0", "further mass flow into chamber b (leaks)"),
    Signal("added_volume_a", "sum", "m3", "0.0", "added to the volume of chamber a"),
    Signal("added_volume_b", "sum", "m3", "0.0", "added to the volume of chamber b"),
    Signal("heat_a", "sum", "W", "0.0", "heat flow into the gas of chamber a"),
    Signal("heat_b", "sum", "W", "0.0", "heat flow into the gas of chamber b"),
    Signal("touched_a", "single", "1", "1.0", "walls that the gas of chamber a touches, over those at mid stroke"),
    Signal("touched_b", "single", "1", "1.0", "walls that the gas of chamber b touches, over those at mid stroke"),
    # piston and friction
    Signal("drive", "single", "N", "U", "drive force on the piston: from the chambers, or the input itself"),
    Signal("force", "sum", "N", "0.0", "load force on the piston, against positive velocity"),
    Signal("friction", "sum", "N", "0.0", "friction force on the piston, against positive velocity"),
    Signal("resistance", "sum", "N s/m", "0.0", "slope of force and friction over velocity, only for stability"),
    Signal("added_mass", "sum", "kg", "0.0", "moves with the piston"),
    Signal("friction_scale", "product", "1", "1.0", "multiplies Coulomb and static friction"),
    Signal("friction_rise", "sum", "N", "0.0", "added to Coulomb and static friction"),
    Signal("static_scale", "product", "1", "1.0", "multiplies static friction alone"),
    Signal("static_rise", "sum", "N", "0.0", "added to static friction alone"),
    Signal("friction_level", "single", "N", "0.0", "of steady sliding at this velocity; at rest static friction"),
    Signal("slip", "single", "m/s", "v", "velocity in the Stribeck curve"),
    Signal(
        "stribeck",
        "single",
        "1",
        "exp(-(slip * slip) * (1.0 / (stribeck_velocity * stribeck_velocity)))",
        "Stribeck decay",
    ),
    # sensors
    Signal("y_measured", "single", "m", "y", "reading of the position sensor"),
    Signal("p_a_measured", "single", "Pa", "p_a", "reading of the pressure sensor of chamber a"),
    Signal("p_b_measured", "single", "Pa", "p_b", "reading of the pressure sensor of chamber b"),
)

SIGNALS: dict[str, Signal] = {signal.name: signal for signal in _TABLE}
DRIVE = "U"  # the input of every machine: valve voltage [V], or driving force [N] without chambers
