"""Record one cylinder, simulated or real, until Ctrl-C.

ros2 launch pneumo_ros record.launch.py namespace:=cylinder_1 output:=run_1
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = [
    DeclareLaunchArgument("namespace", default_value="", description="namespace of the cylinder; empty for none"),
    DeclareLaunchArgument("output", description="folder to record into; it must not exist yet"),
]


def generate_launch_description() -> LaunchDescription:
    """The recorder alone."""
    output = ParameterValue(LaunchConfiguration("output"), value_type=str)  # YAML takes 2030_01_02 for a number
    recorder = Node(
        package="pneumo_ros",
        executable="recorder",
        namespace=LaunchConfiguration("namespace"),
        parameters=[{"output": output}],
        output="screen",
    )
    return LaunchDescription([*ARGUMENTS, recorder])
