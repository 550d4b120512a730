"""What to record next: to distinguish an added effect from its rivals, or to see more of an unexplained residual."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from pneumo_ros.compare.wording import EQUATIONS, VARIABLES
from pneumo_ros.errors import PneumoError
from pneumo_ros.units import LINE

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Addition, Outcome, Unexplained
    from pneumo_ros.plant import Model

# variable that a residual follows -> experiment that takes it through its range while the others stay
SHOWING = {
    "velocity": "constant-voltage", "position": "full-strokes", "voltage": "triangle", "force": "slow-reversals",
    "pressure_a": "hold", "pressure_b": "hold", "pressure_difference": "hold", "time": "pauses",
}  # fmt: skip

SHOWN_BY = {  # where an effect acts, or its name -> experiment that shows it
    "chamber": "hold", "friction": "slow-reversals", "line": "fast-reversals", "piston": "fast-reversals",
    "motor": "fast-reversals", "sensor": "fast-reversals", "valve": "triangle", "constant_load": "slow-reversals",
    "cushioning": "full-strokes",
    "dwell_time_breakaway": "pauses", "friction_lag": "fast-reversals", "friction_warmup": "pauses",
    "position_dependent_friction": "full-strokes", "pressure_sensor_offset": "vent", "spring_load": "full-strokes",
    "supply_pressure_droop": "full-strokes", "choked_flow": "full-strokes", "valve_spool_dynamics": "fast-reversals",
}  # fmt: skip
ANY = "steps"  # for an effect of a user


def cannot_say(outcome: "Outcome") -> list[dict[str, str]]:
    """Effects that these recordings neither show nor exclude, why not, and the experiment that shows them.

    They would not show the usual size, or they speak for the effect, but not enough. Not those that breakaways showed
    after the equations did not. An axis without valve or one that turns is to be moved by other means.
    """
    from pneumo_ros.diagnose.score import MARGIN

    if not outcome.steps:
        return []
    library, last, found = outcome.model.library, outcome.steps[-1], list[dict[str, str]]()
    asked = f"and {MARGIN:g} are asked"
    would = "of its usual size it would gain {:.1f} nats in these recordings"
    gain = "these recordings gain {:.1f} nats with it"
    told = {name: f"{would.format(max(nats, 0.0))}, {asked}" for name, nats in last.unseen.items()}
    for name, one in last.undecided.items():
        why = asked if one.score.nats < MARGIN else f"but: {'; '.join(one.objections)}"
        told[name] = f"{gain.format(one.score.nats)}, {why}"
    added, by_hand = {one.effect for one in outcome.added}, _without_experiments(outcome.model)
    for name, why in ((name, why) for name, why in told.items() if name not in added):
        room = library.find(name).__module__.split(".")[-2]
        motion = SHOWN_BY.get(name, SHOWN_BY.get(room, ANY))
        experiment = f"record {motion.replace('-', ' ')}" if by_hand else f"pneumo experiment {motion}"
        found.append({"effect": name, "because": why, "experiment": experiment})
    return found


def _without_experiments(model: "Model") -> bool:
    return model.force_driven or model.coordinate != LINE


def suggested(outcome: "Outcome", machine: str, progress: Callable[[float], None] = lambda share: None) -> str:
    """A sentence, "" where there is nothing to distinguish or no time left; `machine` is what --model takes.

    `progress` is called with the share done.
    """
    if outcome.interrupted or outcome.deadline or _without_experiments(outcome.model):
        return ""
    for added in outcome.added:
        if added.indistinguishable_from:
            return _separating(outcome, added, machine, progress)
    return _showing(outcome.unexplained, machine) if outcome.unexplained else ""


def _separating(outcome: "Outcome", added: "Addition", machine: str, progress: Callable[[float], None]) -> str:
    """The experiment that best distinguishes an effect from its first rival."""
    from pneumo_ros.experiment.separate import separate
    from pneumo_ros.experiment.suggestion import suggestion

    rival = added.indistinguishable_from[0]
    try:
        ranked = separate(outcome.model.measuring(()), added.effect, rival, progress=progress)
    except PneumoError as problem:  # the diagnosis is valid without it
        return f"No experiment that distinguishes {added.effect} from {rival} could be simulated: {problem}."
    except KeyboardInterrupt:
        return ""
    return suggestion(ranked, added.effect, rival, machine)


def _showing(left: "Unexplained", machine: str) -> str:
    if not left.against:
        where = EQUATIONS[left.equation][0]
        return f"To see what the residual in {where} follows: pneumo experiment {ANY} --model {machine}."
    return (
        f"To see more of the residual in {EQUATIONS[left.equation][0]}, which {VARIABLES[left.against][0]} explains "
        f"best: pneumo experiment {SHOWING[left.against]} --model {machine}."
    )
