"""What the controller reports on /diagnostics."""

from pneumo_ros.axis.controller.guide import Guide, Mode
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
    errors += [f"{loop.fault}: sending 0 V"] if loop.fault else []
    return Health(values, _warnings(loop, age, stale), errors)


class Growth:
    """Warnings on counts that have grown since the last look, about once a second."""

    def __init__(self) -> None:
        self._before: tuple[int, ...] | None = None

    def warnings(self, loop: Loop) -> list[str]:
        """Sentences on what has grown; the first look has nothing to compare with."""
        now = (loop.measured, loop.saturated, loop.restarts, loop.refused)
        before, self._before = self._before or now, now
        measured, saturated, restarts, refused = (new - old for new, old in zip(now, before, strict=True))
        said = {
            f"{saturated} of {measured} commands at the limit of the voltage": saturated > 0.5 * measured > 0.0,
            f"{restarts} restarts after pauses of the measurements": restarts > 0,
            f"{refused} inputs refused": refused > 0,
        }
        return [sentence for sentence, grown in said.items() if grown]


def _warnings(loop: Loop, age: float | None, stale: bool) -> list[str]:
    missing = "no measurement yet" if age is None else "measurements are missing: sending 0 V"
    warnings = [missing] if age is None or stale else _missing_pressures(loop)
    if not loop.guide.motion.asked:
        warnings.append("no reference yet: holding 0 V")
    warnings += [loop.stall.warning] if loop.stall.warning else []
    warnings += stuck(loop.guide)
    if loop.guide.supply.silent:
        warnings.append("supply/pressure is silent: counting with that of the machine file")
    return warnings if loop.guide.mode is Mode.FOLLOWING else [*warnings, loop.guide.mode.value]


def stuck(guide: Guide) -> list[str]:
    """A sentence for each side to which the machine cannot start: friction and load exceed its force."""
    able = guide.capability
    return [
        f"the machine cannot {word}: friction and load are {able.breakaway(side):.3g} N, its force is "
        f"{float(able.force(0.0, side)):.3g} N"
        for word, side in (("extend", 1.0), ("retract", -1.0))
        if able.breakaway(side) > float(able.force(0.0, side))
    ]


def _missing_pressures(loop: Loop) -> list[str]:
    """A warning if the law needs pressures that nobody sends."""
    known, topics = loop.pressures, {"a": PRESSURE_A, "b": PRESSURE_B}
    silent = [topic for chamber, topic in topics.items() if known[chamber] is None]
    if not (silent and loop.law.reads_pressures):
        return []
    return [f"the law needs {' and '.join(silent)}, which nobody sends: sending 0 V"]
