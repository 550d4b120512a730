"""What to record next: to distinguish an added effect from its rivals, or to see more of an unexplained residual."""

from typing import TYPE_CHECKING

from pneumo_ros.command.console import Console
from pneumo_ros.compare.wording import EQUATIONS, VARIABLES
from pneumo_ros.errors import PneumoError

if TYPE_CHECKING:
    from pneumo_ros.diagnose.outcome import Addition, Outcome, Unexplained

# variable that a residual follows -> experiment that takes it through its range while the others stay
SHOWING = {
    "velocity": "constant-voltage", "position": "full-strokes", "voltage": "triangle", "force": "slow-reversals",
    "pressure_a": "hold", "pressure_b": "hold", "pressure_difference": "hold", "time": "pauses",
}  # fmt: skip


def suggested(outcome: "Outcome", machine: str, console: Console) -> str:
    """A sentence, "" where there is nothing to distinguish or no time left; `machine` is what --model takes."""
    if outcome.interrupted or outcome.deadline or outcome.model.force_driven:
        return ""
    for added in outcome.added:
        if added.indistinguishable_from:
            return _separating(outcome, added, machine, console)
    return _showing(outcome.unexplained, machine) if outcome.unexplained else ""


def _separating(outcome: "Outcome", added: "Addition", machine: str, console: Console) -> str:
    """The experiment that best distinguishes an effect from its first rival."""
    from pneumo_ros.experiment.separate import separate
    from pneumo_ros.experiment.suggestion import suggestion

    rival = added.indistinguishable_from[0]
    try:
        with console.progress("Choosing an experiment") as progress:
            ranked = separate(outcome.model, added.effect, rival, progress=progress)
    except PneumoError as problem:  # the diagnosis is valid without it
        return f"No experiment that distinguishes {added.effect} from {rival} could be simulated: {problem}."
    except KeyboardInterrupt:
        return ""
    return suggestion(ranked, added.effect, rival, machine)


def _showing(left: "Unexplained", machine: str) -> str:
    return (
        f"To see more of the residual in {EQUATIONS[left.equation][0]}, which {VARIABLES[left.against][0]} explains "
        f"best: pneumo experiment {SHOWING[left.against]} --model {machine}."
    )
