"""A whole round: an experiment on a rig is recorded and identified, and a simulator of the rig, the twin, is corrected.

The rig is a simulator with sensors as noisy as real ones, or your own: then name its namespace, and it will move.

ros2 launch pneumo_ros identify.launch.py rig_params:=rig.yaml twin_params:=guess.yaml folder:=runs
ros2 launch pneumo_ros identify.launch.py simulate:=false rig:=cylinder_1 rig_file:=rig.yaml twin_params:=guess.yaml
"""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, Shutdown
from launch.conditions import IfCondition
from launch.events.process import ProcessExited
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

DEFAULT_MACHINE = PathJoinSubstitution([FindPackageShare("pneumo_ros"), "config", "axis.yaml"])
SENSORS = {"noise_position": 5e-6, "noise_pressure": 300.0, "publish_velocity": False}
PATIENCE = {"lockstep_wait": 60.0, "lockstep_timeout": 10.0}  # where real_time_factor is 0

ARGUMENTS = [
    DeclareLaunchArgument("rig", default_value="rig", description="namespace of the rig"),
    DeclareLaunchArgument("simulate", default_value="true", description="simulate the rig; false: there is a real one"),
    DeclareLaunchArgument("rig_params", default_value=DEFAULT_MACHINE, description="machine file of a simulated rig"),
    DeclareLaunchArgument(
        "real_time_factor", default_value="1.0", description="of a simulated rig; 0.0: as fast as possible"
    ),
    DeclareLaunchArgument(
        "rig_file", default_value="", description="rig file of a rig of your own: wiring, closed signal, limits"
    ),
    DeclareLaunchArgument("twin", default_value="twin", description="namespace of the simulator that is corrected"),
    DeclareLaunchArgument(
        "twin_params", default_value=DEFAULT_MACHINE, description="machine file of the twin: what is known of the rig"
    ),
    DeclareLaunchArgument("folder", default_value="runs", description="folder for the recordings"),
    DeclareLaunchArgument("output", default_value="identified", description="folder for the machine files"),
    DeclareLaunchArgument(
        "programme", default_value="", description="programme file of the experiment; none: constant-voltage"
    ),
    DeclareLaunchArgument(
        "timeout",
        default_value=PythonExpression(["2.0 if '", LaunchConfiguration("simulate"), "' == 'true' else 0.2"]),
        description="silence of the rig that ends the experiment [s]; longer where it is simulated, on a busy PC",
    ),
    DeclareLaunchArgument(
        "auto", default_value="true", description="identify as recordings arrive; false: on ~/identify"
    ),
]


def typed(argument: LaunchConfiguration, kind: type) -> ParameterValue:
    """A launch argument as a parameter of this type, whatever it looks like."""
    return ParameterValue(argument, value_type=kind)


def end_of_experiment(event: ProcessExited, context: LaunchContext) -> list[Shutdown]:
    """Nothing after a whole experiment; otherwise the end of everything, since no further recording will come."""
    if event.returncode == 0:
        return []
    kept = f"what it recorded is in {context.launch_configurations['folder']}: pneumo identify reads it"
    return [Shutdown(reason=f"the experiment ended with exit code {event.returncode}, as its last line says; {kept}")]


def generate_launch_description() -> LaunchDescription:
    """Rig, twin, experiment and identification."""
    rig, twin = LaunchConfiguration("rig"), LaunchConfiguration("twin")
    plant = Node(
        package="pneumo_ros",
        executable="simulator",
        namespace=rig,
        parameters=[
            LaunchConfiguration("rig_params"),
            {**SENSORS, **PATIENCE, "real_time_factor": typed(LaunchConfiguration("real_time_factor"), float)},
        ],
        output="screen",
        condition=IfCondition(LaunchConfiguration("simulate")),
    )
    corrected = Node(
        package="pneumo_ros",
        executable="simulator",
        namespace=twin,
        parameters=[LaunchConfiguration("twin_params")],
        output="screen",
    )
    experiment = Node(
        package="pneumo_ros",
        executable="experiment",
        namespace=rig,
        parameters=[
            {
                "programme": typed(LaunchConfiguration("programme"), str),
                "model": typed(LaunchConfiguration("twin_params"), str),
                "rig": typed(LaunchConfiguration("rig_file"), str),
                "output": typed(LaunchConfiguration("folder"), str),
                "measurement_timeout": typed(LaunchConfiguration("timeout"), float),
                "wait": 60.0,
            }
        ],
        output="screen",
        on_exit=end_of_experiment,
    )
    identification = Node(
        package="pneumo_ros",
        executable="identification",
        namespace="identified",  # its description is of what was identified, and must not mix with the rig's
        parameters=[
            {
                "folder": typed(LaunchConfiguration("folder"), str),
                "model": typed(LaunchConfiguration("twin_params"), str),
                "rig": typed(LaunchConfiguration("rig_file"), str),
                "output": typed(LaunchConfiguration("output"), str),
                "auto": typed(LaunchConfiguration("auto"), bool),
                "apply": True,
                "target": ParameterValue(["/", twin, "/simulator"], value_type=str),
            }
        ],
        output="screen",
    )
    return LaunchDescription([*ARGUMENTS, plant, corrected, experiment, identification])
