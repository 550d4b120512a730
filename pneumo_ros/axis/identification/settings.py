"""Parameters of the identification."""

from pneumo_ros.axis.rig import SETTINGS as RIG
from pneumo_ros.axis.setting import Setting

SETTINGS = (
    Setting("bags", [""], "recordings of constant-voltage runs"),
    Setting("folder", "", "folder to watch for more of them, itself or one folder deeper"),
    Setting("axis", "", "namespace of the axis, where a recording holds several"),
    Setting("joint_name", "", "joint of the axis, where a recording holds several and none is called piston"),
    *(setting for setting in RIG if setting.name != "closed_signal"),
    Setting("model", "axis", "machine file, or name of a shipped one, to start from", live=False),
    Setting("output", "identified", "folder for machine files; each gets a number of its own", live=False),
    Setting("auto", True, "identify as recordings arrive; otherwise only on ~/identify"),
    Setting("quiet", 5.0, "time without a new recording before it identifies", "s", 0.0, 3600.0),
    Setting("whole_model", False, "then refit all parameters that are not measured otherwise, to the same runs"),
    Setting("apply", False, "set what was identified on the node `target`, all at once"),
    Setting("target", "simulator", "node to set it on; in this node's namespace unless it starts with /"),
)
