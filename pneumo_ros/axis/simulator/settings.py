"""Parameters of the simulator beside those of its machine."""

from pneumo_ros.axis.priority import PRIORITY
from pneumo_ros.axis.setting import Setting
from pneumo_ros.plant import Model, Parameter
from pneumo_ros.plant.model import STEP
from pneumo_ros.records.contract import JOINT

EFFECTS = "effects"

FIXED = (
    Setting("model", "axis", "machine file or name of a shipped one; other parameters change it", live=False),
    Setting("joint_name", JOINT, "name of the joint in joint_states", live=False),
    Setting("publish_rate", 500.0, "rate of joint states and pressures", "Hz", 1.0, 1000.0, live=False),
    Setting("step", STEP, "integration step", "s", 1e-6, 1e-3, live=False),
    Setting("wired_as", "", "wiring of the rig that is played: words such as bar,gauge,swapped-chambers", live=False),
    Setting("seed", 0, "of the sensor noise", "", 0, 2**31 - 1, live=False),
    PRIORITY,
    Setting("start_paused", False, "wait for ~/pause with data: false, so that recorders miss nothing", live=False),
    Setting("publish_clock", False, "send simulated time on /clock and stamp messages with it", live=False),
    Setting(
        "real_time_factor", 1.0,
        "simulated over real time; 0: as fast as possible, one valve command per measurement (implies publish_clock)",
        "", 0.0, 100.0, live=False,
    ),
    Setting(
        "coupled", False, "another simulator moves the rod: coupled/joint_states in, coupled/effort out, its clock",
        live=False,
    ),
    Setting("lockstep_wait", 10.0, "longest wait for a controller before lockstep", "s", 0.0, 3600.0, live=False),
    Setting("lockstep_timeout", 1.0, "longest wait for a command in lockstep", "s", 0.01, 3600.0, live=False),
)  # fmt: skip

LIVE = (
    Setting("command_timeout", 0.1, "simulated age of a command at which the valve closes; 0: never", "s", 0.0, 1e6),
    Setting("max_voltage", 10.0, "commands beyond it are clipped", "V", 0.0, 100.0),
    Setting("force_timeout", 0.0, "simulated age at which an external force ends; 0: never", "s", 0.0, 1e6),
    Setting("publish_velocity", True, "fill the velocity of joint_states; position sensors do not measure it"),
    Setting("noise_position", 0.0, "standard deviation of the position noise", "m", 0.0, 0.1),
    Setting("noise_pressure", 0.0, "standard deviation of the pressure noise", "Pa", 0.0, 1e5),
    Setting("quantisation_position", 0.0, "step of the position sensor; 0: none", "m", 0.0, 0.1),
    Setting("quantisation_pressure", 0.0, "step of the pressure sensors; 0: none", "Pa", 0.0, 1e5),
    Setting("initial.y", 0.0, "position at the start and after a reset", "m", -100.0, 100.0),
    Setting("initial.v", 0.0, "velocity at the start and after a reset", "m/s", -100.0, 100.0),
    Setting("initial.p_a", 0.0, "pressure a at the start and after a reset; 0: the atmosphere's", "Pa", 0.0, 1e8),
    Setting("initial.p_b", 0.0, "pressure b at the start and after a reset; 0: the atmosphere's", "Pa", 0.0, 1e8),
)  # fmt: skip


OF_ONE_AXIS = frozenset({"joint_name", "wired_as", *(setting.name for setting in LIVE)})
"""Parameters that each of several axes may have of its own, behind its name: lift.noise_position."""
OF_ALL_AXES = tuple(setting for setting in FIXED if setting.name not in OF_ONE_AXIS)


def machine_settings(model: Model, names: list[str]) -> list[Setting]:
    """Settings of the machine's parameters of the given dotted names; the present values are the defaults."""
    return [_setting(name, model[name], model.specification(name)) for name in names]


def _setting(name: str, value: float, given: Parameter) -> Setting:
    unit = "" if given.unit == "1" else given.unit
    return Setting(name, value, given.meaning, unit, given.low, given.high)


def effects_setting(model: Model) -> Setting:
    """The list of effects as a parameter."""
    return Setting(
        EFFECTS, list(model.effects), "effects the machine consists of, in order (pneumo effects lists them)"
    )
