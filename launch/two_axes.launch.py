"""The pruning arm: one simulator of both cylinders on their supply, a controller in the namespace of each, and the TF.

ros2 launch pneumo_ros two_axes.launch.py rviz:=true
ros2 topic pub --once /lift/position/reference std_msgs/msg/Float64 "{data: 0.2}"
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

SHARE = FindPackageShare("pneumo_ros")
MACHINE = PathJoinSubstitution([SHARE, "config", "arm", "pruning.yaml"])  # with the weight that the lift carries
CARRYING = {"lift.initial.p_a": 3.33e5, "lift.initial.p_b": 3.0e5}  # Pa: simulated, it hangs in its air
DEFAULT_CONTROL = PathJoinSubstitution([SHARE, "config", "control", "pid.yaml"])
AXES = ("lift", "reach")  # of the machine file, and namespaces; joints are lift_piston and reach_piston

ARGUMENTS = [
    DeclareLaunchArgument("params", default_value=MACHINE, description="machine file of the axes lift and reach"),
    DeclareLaunchArgument("lift_control", default_value=DEFAULT_CONTROL, description="control file of the lift"),
    DeclareLaunchArgument("reach_control", default_value=DEFAULT_CONTROL, description="control file of the reach"),
    DeclareLaunchArgument("simulate", default_value="true", description="simulate both; false: there is a real arm"),
    DeclareLaunchArgument("rviz", default_value="false", description="show the arm in rviz"),
]


def simulator() -> Node:
    """Both cylinders in one kernel: what one of them draws, the other one lacks."""
    joints = {f"{name}.joint_name": f"{name}_piston" for name in AXES}
    return Node(
        package="pneumo_ros",
        executable="simulator",
        parameters=[LaunchConfiguration("params"), {**joints, **CARRYING}],
        output="screen",
        condition=IfCondition(LaunchConfiguration("simulate")),
    )


def controller(name: str, control: LaunchConfiguration) -> Node:
    """It takes the axis whose name is its namespace from the machine file."""
    return Node(
        package="pneumo_ros",
        executable="controller",
        namespace=name,
        parameters=[control, LaunchConfiguration("params"), {"joint_name": f"{name}_piston"}],
        output="screen",
    )


def generate_launch_description() -> LaunchDescription:
    """Both axes, their joint states in one message, the transforms of the arm."""
    urdf = PathJoinSubstitution([SHARE, "urdf", "pruning_arm.urdf.xacro"])
    description = {"robot_description": ParameterValue(Command(["xacro ", urdf]), value_type=str)}
    joints = Node(
        package="joint_state_publisher",
        executable="joint_state_publisher",
        parameters=[{"source_list": [f"/{name}/joint_states" for name in AXES], "rate": 50}, description],
    )
    publisher = Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[description])
    controllers = [
        controller("lift", LaunchConfiguration("lift_control")),
        controller("reach", LaunchConfiguration("reach_control")),
    ]
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", PathJoinSubstitution([SHARE, "config", "rviz", "pruning_arm.rviz"])],
        condition=IfCondition(LaunchConfiguration("rviz")),
    )
    return LaunchDescription([*ARGUMENTS, simulator(), *controllers, joints, publisher, rviz])
