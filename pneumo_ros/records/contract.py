"""Topics that all recordings, nodes and tools share: names relative to the namespace of the axis, and their types."""

from pneumo_ros.measured import PLAIN

JOINT_STATES = "joint_states"
PRESSURE_A = "chamber_a/pressure"
PRESSURE_B = "chamber_b/pressure"
SUPPLY_PRESSURE = "supply/pressure"
COMMAND = "valve/command"
COMMAND_B = "valve_b/command"  # of the valve of chamber b, where each chamber has one
LOAD_CELL = "load_cell"  # measured rod force
FORCE = "external/force"  # on the rod of a simulated plant
COUPLED = "coupled/joint_states"  # the rod's state in another simulator
COUPLED_MASS = "coupled/effective_mass"  # of the mechanism there, along the rod
COUPLED_EFFORT = "coupled/effort"  # the cylinder's force on it
REFERENCE = "position/reference"
SETPOINT = "setpoint"  # the controller's present setpoint, for plots
DESCRIPTION = "description"

TYPES = {
    JOINT_STATES: "sensor_msgs/msg/JointState",
    PRESSURE_A: "sensor_msgs/msg/FluidPressure",
    PRESSURE_B: "sensor_msgs/msg/FluidPressure",
    SUPPLY_PRESSURE: "sensor_msgs/msg/FluidPressure",
    COMMAND: "std_msgs/msg/Float64",
    COMMAND_B: "std_msgs/msg/Float64",
    LOAD_CELL: "sensor_msgs/msg/JointState",
    FORCE: "std_msgs/msg/Float64",
    REFERENCE: "std_msgs/msg/Float64",
    "joint_trajectory": "trajectory_msgs/msg/JointTrajectory",
    "joint_commands": "sensor_msgs/msg/JointState",
    SETPOINT: "sensor_msgs/msg/JointState",
    DESCRIPTION: "std_msgs/msg/String",
    **{one.topic: "std_msgs/msg/Float64" for one in PLAIN.values()},
}
GLOBAL_TYPES = {
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    "/clock": "rosgraph_msgs/msg/Clock",
}
LATCHED = frozenset({DESCRIPTION})  # published transient local
JOINT = "piston"  # the default name

# The topics of a recording of the axis; the others belong to its control.
SIGNALS = (
    JOINT_STATES, PRESSURE_A, PRESSURE_B, SUPPLY_PRESSURE, COMMAND, COMMAND_B, LOAD_CELL,
    *(one.topic for one in PLAIN.values()), DESCRIPTION,
)  # fmt: skip


def split(topic: str) -> tuple[str, str] | None:
    """Namespace and contract name of a recorded topic; None for an unknown topic.

    The namespace has no slashes at its ends, and is "" for the root.
    """
    plain = topic.strip("/")
    for name in TYPES:
        if plain == name:
            return "", name
        if plain.endswith("/" + name):
            return plain[: -len(name) - 1], name
    return None
