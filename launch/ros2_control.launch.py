"""One cylinder below ros2_control: the plant and its controller in a namespace, a joint_trajectory_controller above.

Needs the packages ros2_control, ros2_controllers, joint_state_topic_hardware_interface (Humble:
topic_based_ros2_control), robot_state_publisher and xacro.

ros2 launch pneumo_ros ros2_control.launch.py namespace:=cylinder_1 rviz:=true
ros2 launch pneumo_ros ros2_control.launch.py control:=my_cascade.yaml params:=my_axis.yaml stroke:=0.5
ros2 launch pneumo_ros ros2_control.launch.py simulate:=false namespace:=rig
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

SHARE = FindPackageShare("pneumo_ros")
DEFAULT_MACHINE = PathJoinSubstitution([SHARE, "config", "axis.yaml"])
DEFAULT_CONTROL = PathJoinSubstitution([SHARE, "config", "control", "pid.yaml"])

ARGUMENTS = [
    DeclareLaunchArgument(
        "namespace",
        default_value="cylinder_1",
        description="namespace of plant and controller; not empty, /joint_states is that of ros2_control",
    ),
    DeclareLaunchArgument("params", default_value=DEFAULT_MACHINE, description="machine file, also read by pneumo"),
    DeclareLaunchArgument("control", default_value=DEFAULT_CONTROL, description="control file: law and gains"),
    DeclareLaunchArgument(
        "rig_file", default_value="", description="rig file of a rig of your own: wiring, closed signal, limits"
    ),
    DeclareLaunchArgument("stroke", default_value="2.0", description="stroke of that machine [m], for the URDF"),
    DeclareLaunchArgument("simulate", default_value="true", description="simulate the plant; false: there is a rig"),
    DeclareLaunchArgument(
        "plugin", default_value="JointStateTopicSystem", description="Jazzy and later; Humble: TopicBasedSystem"
    ),
    DeclareLaunchArgument("rviz", default_value="false", description="show the cylinder in rviz"),
]


def robot(namespace: LaunchConfiguration) -> Command:
    """The URDF of the cylinder."""
    urdf = PathJoinSubstitution([SHARE, "urdf", "axis.urdf.xacro"])
    stroke, plugin = LaunchConfiguration("stroke"), LaunchConfiguration("plugin")
    return Command(["xacro ", urdf, " namespace:=", namespace, " stroke:=", stroke, " plugin:=", plugin])


def generate_launch_description() -> LaunchDescription:
    """Simulator and controller below, ros2_control and its controllers above, which own /joint_states."""
    namespace, machine = LaunchConfiguration("namespace"), LaunchConfiguration("params")
    description = {"robot_description": ParameterValue(robot(namespace), value_type=str)}
    controllers = PathJoinSubstitution([SHARE, "config", "ros2_control", "controllers.yaml"])
    simulator = Node(
        package="pneumo_ros",
        executable="simulator",
        namespace=namespace,
        parameters=[machine],
        output="screen",
        condition=IfCondition(LaunchConfiguration("simulate")),
    )
    controller = Node(
        package="pneumo_ros",
        executable="controller",
        namespace=namespace,
        parameters=[
            LaunchConfiguration("control"),
            machine,
            {"rig": ParameterValue(LaunchConfiguration("rig_file"), value_type=str)},
        ],
        output="screen",
    )
    publisher = Node(package="robot_state_publisher", executable="robot_state_publisher", parameters=[description])
    manager = Node(
        package="controller_manager",
        executable="ros2_control_node",
        parameters=[controllers],
        remappings=[("~/robot_description", "/robot_description")],
        output="screen",
    )
    spawner = Node(
        package="controller_manager",
        executable="spawner",
        arguments=["joint_state_broadcaster", "joint_trajectory_controller"],
        output="screen",
    )
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        arguments=["-d", PathJoinSubstitution([SHARE, "config", "rviz", "axis.rviz"])],
        condition=IfCondition(LaunchConfiguration("rviz")),
    )
    return LaunchDescription([*ARGUMENTS, simulator, controller, publisher, manager, spawner, rviz])
