"""What the controller reports on /diagnostics."""

from pneumo_ros.axis.controller.guide import Mode
from pneumo_ros.axis.controller.loop import Loop
from pneumo_ros.axis.health import Health
from pneumo_ros.records.contract import PRESSURE_A, PRESSURE_B


def health_of(loop: Loop, refused: str, age: float | None, stale: bool) -> Health:
    """Counts, errors and what is missing; `age` [s] of the last measurement, None before the first one.

    `refused` is the last refusal and its reason.
    """
    guide = loop.guide
    values: dict[str, object] = {"measurements": loop.measured, "rejected_inputs": loop.refused, "refused": refused}
    values |= {"saturated_commands": loop.saturated, "restarts": loop.restarts, "voltage_V": loop.voltage}
    values |= {"mode": guide.mode.value, "motion": guide.motion.kind.value, "reason": guide.motion.reason}
    if age is not None:
        values["measurement_age_s"] = age
    if loop.wanted is not None and guide.position is not None:
        values["position_error_m"] = loop.wanted.position - guide.position
    errors = ["supply pressure lost: sending 0 V"] if guide.supply.lost else []
    return Health(values, _warnings(loop, age, stale), errors)


def _warnings(loop: Loop, age: float | None, stale: bool) -> list[str]:
    missing = "no measurement yet" if age is None else "measurements are missing: sending 0 V"
    warnings = [missing] if age is None or stale else _missing_pressures(loop)
    if not loop.guide.motion.asked:
        warnings.append("no reference yet: holding 0 V")
    return warnings if loop.guide.mode is Mode.FOLLOWING else [*warnings, loop.guide.mode.value]


def _missing_pressures(loop: Loop) -> list[str]:
    """A warning if the law needs pressures that nobody sends."""
    known, topics = loop.pressures, {"a": PRESSURE_A, "b": PRESSURE_B}
    silent = [topic for chamber, topic in topics.items() if known[chamber] is None]
    if not (silent and loop.law.reads_pressures):
        return []
    return [f"the law needs {' and '.join(silent)}, which nobody sends: sending 0 V"]
