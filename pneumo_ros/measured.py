"""What else recordings may hold beside motion, chamber pressures and the command: one row for each signal.

Every room takes it from here: recordings and bags read and write it, maps of tables have it, the terminal shows it, and
effects read it as an input of that name. A new sensor is one row, and one effect if it has a law.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Measured:
    """One row: its name in recordings and maps of tables, topic, SI unit, meaning, and its name in equations.

    `dimensions` of the units in which a table may have it; `shown`: unit and factor for the terminal; `flips`: whether
    its sign changes with that of the position. The topic is a std_msgs/Float64 unless the contract says otherwise.
    """

    name: str
    topic: str
    unit: str
    meaning: str
    input: str
    dimensions: tuple[str, ...]
    shown: tuple[str, float]
    flips: bool = False
    held: bool = False  # whether a value lasts until the next one, as a command does


MEASURED = (
    Measured(
        "supply_pressure", "supply/pressure", "Pa", "measured supply pressure, absolute", "measured_supply",
        ("pressure",), ("bar", 1e-5),
    ),
    Measured(
        "load_cell", "load_cell", "N", "measured rod force, positive where positive positions are", "load_force",
        ("force", "torque"), ("N", 1.0), flips=True,
    ),
    Measured(
        "flow_a", "chamber_a/flow", "kg/s", "measured mass flow into chamber a", "metered_flow_a",
        ("mass flow",), ("g/s", 1e3),
    ),
    Measured(
        "reference", "position/reference", "m", "wanted position, of the loop that moves the machine", "reference",
        ("length", "angle"), ("mm", 1e3), flips=True, held=True,
    ),
    Measured(
        "loop_gain", "loop/gain", "1/m", "gain of the position loop, share of full voltage over error", "loop_gain",
        ("ratio",), ("1/m", 1.0), held=True,
    ),
    Measured(
        "supply_voltage", "supply/voltage", "V", "voltage at the driver of a motor", "measured_voltage",
        ("voltage",), ("V", 1.0),
    ),
    Measured(
        "motor_on", "motor/on", "1", "whether the driver of a motor is on, 1 or 0", "motor_on",
        ("ratio",), ("", 1.0), held=True,
    ),
)  # fmt: skip

OWN = ("supply_pressure", "load_cell")  # those with a message type and a field of recordings of their own
PLAIN = {one.name: one for one in MEASURED if one.name not in OWN}
