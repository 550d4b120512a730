"""The pneumatic axis under position control: simulator and controller, in one namespace, recorded if wanted.

ros2 launch pneumo_ros axis.launch.py namespace:=cylinder_1 record:=run_1
ros2 launch pneumo_ros axis.launch.py control:=my_cascade.yaml params:=my_axis.yaml
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

DEFAULT_MACHINE = PathJoinSubstitution([FindPackageShare("pneumo_ros"), "config", "axis.yaml"])
DEFAULT_CONTROL = PathJoinSubstitution([FindPackageShare("pneumo_ros"), "config", "control", "pid.yaml"])

ARGUMENTS = [
    DeclareLaunchArgument("namespace", default_value="", description="namespace of this cylinder; empty for none"),
    DeclareLaunchArgument("params", default_value=DEFAULT_MACHINE, description="machine file, also read by pneumo"),
    DeclareLaunchArgument("control", default_value=DEFAULT_CONTROL, description="control file: law and gains"),
    DeclareLaunchArgument(
        "rig_file", default_value="", description="rig file of a rig of your own: wiring, closed signal, limits"
    ),
    DeclareLaunchArgument("record", default_value="", description="folder to record into; empty records nothing"),
]


def generate_launch_description() -> LaunchDescription:
    """Simulator, controller and, when `record` names a folder, the recorder."""
    namespace = LaunchConfiguration("namespace")
    record = LaunchConfiguration("record")
    machine = [LaunchConfiguration("params")]  # the controller takes the dead zone from it
    simulator = Node(
        package="pneumo_ros", executable="simulator", namespace=namespace, parameters=machine, output="screen"
    )
    controller = Node(
        package="pneumo_ros",
        executable="controller",
        namespace=namespace,
        parameters=[
            LaunchConfiguration("control"),
            *machine,
            {"rig": ParameterValue(LaunchConfiguration("rig_file"), value_type=str)},
        ],
        output="screen",
    )
    recorder = Node(
        package="pneumo_ros",
        executable="recorder",
        namespace=namespace,
        parameters=[{"output": ParameterValue(record, value_type=str)}],
        output="screen",
        condition=IfCondition(PythonExpression(["'", record, "' != ''"])),
    )
    return LaunchDescription([*ARGUMENTS, simulator, controller, recorder])
