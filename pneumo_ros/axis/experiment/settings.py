"""Parameters of the experiment."""

from pneumo_ros.axis.priority import PRIORITY
from pneumo_ros.axis.rig import SETTINGS as RIG
from pneumo_ros.axis.setting import Setting
from pneumo_ros.records.contract import JOINT

SETTINGS = (
    Setting("programme", "", "programme file to run; none: `experiment` for `model`", live=False),
    Setting("experiment", "constant-voltage", "experiment to run without a programme file", live=False),
    Setting("model", "axis", "machine file, or name of a shipped one, that such a programme is made for", live=False),
    Setting("output", "", "folder for the recordings; none: experiment_ and the time, here", live=False),
    Setting("joint_name", JOINT, "name of the joint in joint_states", live=False),
    *RIG,
    Setting("measurement_timeout", 0.2, "silence of the plant that ends the experiment", "s", 0.01, 60.0, live=False),
    PRIORITY,
    Setting("wait", 10.0, "longest wait for the plant at the start", "s", 0.0, 3600.0, live=False),
    Setting("events", False, "report progress on stdout as lines of JSON; the end of stdin ends it", live=False),
)  # fmt: skip
