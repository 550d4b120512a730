"""Record one cylinder, simulated or real, until Ctrl-C.

ros2 launch pneumo_ros record.launch.py namespace:=cylinder_1 output:=run_1
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = [
    DeclareLaunchArgument("namespace", default_value="", description="namespace of the cylinder; empty for none"),
    DeclareLaunchArgument("output", description="folder to record into; it must not exist yet"),
]


def generate_launch_description() -> LaunchDescription:
    """The recorder alone."""
    recorder = Node(
        package="pneumo_ros",
        executable="recorder",
        namespace=LaunchConfiguration("namespace"),
        parameters=[{"output": LaunchConfiguration("output")}],
        output="screen",
    )
    return LaunchDescription([*ARGUMENTS, recorder])
