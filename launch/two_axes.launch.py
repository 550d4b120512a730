"""The pruning arm: two cylinders, each with its simulator and controller in a namespace of its own, and the arm as TF.

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
LIFT_MACHINE = PathJoinSubstitution([SHARE, "config", "arm", "lift.yaml"])  # with the weight that it lifts
REACH_MACHINE = PathJoinSubstitution([SHARE, "config", "arm", "reach.yaml"])
CARRYING = {"lift": {"initial.p_a": 3.33e5, "initial.p_b": 3.0e5}, "reach": {}}  # Pa: simulated, it hangs in its air
DEFAULT_CONTROL = PathJoinSubstitution([SHARE, "config", "control", "pid.yaml"])
AXES = ("lift", "reach")  # namespaces; joints are lift_piston and reach_piston

ARGUMENTS = [
    DeclareLaunchArgument("lift_params", default_value=LIFT_MACHINE, description="machine file of the lift"),
    DeclareLaunchArgument("reach_params", default_value=REACH_MACHINE, description="machine file of the reach"),
    DeclareLaunchArgument("lift_control", default_value=DEFAULT_CONTROL, description="control file of the lift"),
    DeclareLaunchArgument("reach_control", default_value=DEFAULT_CONTROL, description="control file of the reach"),
    DeclareLaunchArgument("simulate", default_value="true", description="simulate both; false: there is a real arm"),
    DeclareLaunchArgument("rviz", default_value="false", description="show the arm in rviz"),
]


def axis(name: str, control: LaunchConfiguration, params: LaunchConfiguration) -> list[Node]:
    """Simulator and controller of one cylinder."""
    parameters = [params, {"joint_name": f"{name}_piston"}]
    simulator = Node(
        package="pneumo_ros",
        executable="simulator",
        namespace=name,
        parameters=[params, {"joint_name": f"{name}_piston", **CARRYING[name]}],
        output="screen",
        condition=IfCondition(LaunchConfiguration("simulate")),
    )
    controller = Node(
        package="pneumo_ros",
        executable="controller",
        namespace=name,
        parameters=[control, *parameters],
        output="screen",
    )
    return [simulator, controller]


def generate_launch_description() -> LaunchDescription:
    """Both axes, their joint states in one message, the transforms of the arm."""
    urdf = PathJoinSubstitution([SHARE, "urdf", "pruning_arm.urdf.xacro"])
    description = {"robot_description": ParameterValue(Command(["xacro ", urdf]), value_type=str)}
    lift = axis("lift", LaunchConfiguration("lift_control"), LaunchConfiguration("lift_params"))
    reach = axis("reach", LaunchConfiguration("reach_control"), LaunchConfiguration("reach_params"))
    joints = Node(
        package="joint_state_publisher",
        executable="joint_state_publisher",
        parameters=[{"source_list": [f"/{name}/joint_states" for name in AXES], "rate": 50}, description],
    )
    publisher = Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[description])
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", PathJoinSubstitution([SHARE, "config", "rviz", "pruning_arm.rviz"])],
        condition=IfCondition(LaunchConfiguration("rviz")),
    )
    return LaunchDescription([*ARGUMENTS, *lift, *reach, joints, publisher, rviz])
