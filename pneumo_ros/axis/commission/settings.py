"""Parameters of the commissioning."""

from pneumo_ros.axis.rig import SETTINGS as RIG
from pneumo_ros.axis.setting import Setting
from pneumo_ros.records.contract import JOINT

SETTINGS = (
    Setting("model", "", "machine file as data sheets tell it (pneumo new); none: that of the rig file, or axis"),
    *RIG,
    Setting("sensors", "", "of pressure, such as gauge-bar or absolute-Pa; none: guessed"),
    Setting("as_wired", False, "go on with swapped or reversed plugs, corrected by the program"),
    Setting("stage", 3, "0: find the wiring and stop; 3: all of it", "", 0, 3),
    Setting("minutes", 5.0, "of moves, at most", "min", 0.01, 600.0),
    Setting("output", "commissioned.yaml", "machine file to write; gains, rig file and recordings go beside it"),
    Setting("report", "", "page to write, such as page.html; none: no page"),
    Setting("evaluations", 40, "sets of gains to try; 0: tune none", "", 0, 10_000),
    Setting("joint_name", JOINT, "name of the joint in joint_states"),
    Setting("measurement_timeout", 0.2, "silence of the plant that ends a move", "s", 0.01, 60.0),
    Setting("auto", True, "begin at the start; otherwise only on ~/start", live=False),
)
