"""What a diagnosis says that its recordings cannot show."""

from types import SimpleNamespace
from typing import Any

from pneumo_ros.command.suggesting import cannot_say
from pneumo_ros.diagnose.steps import Step
from pneumo_ros.plant import load_model


def outcome(*added: str, machine: str = "axis") -> Any:
    """As much of an outcome as is asked: a last round that shows neither of two effects, and what was added."""
    model = load_model(machine)
    last = Step(model, (), None, (), {}, {}, {"friction_lag": 0.0, "cushioning": 0.1})
    return SimpleNamespace(model=model, steps=(last,), added=[SimpleNamespace(effect=name) for name in added])


def test_an_effect_that_breakaways_showed_is_not_called_invisible() -> None:
    assert [one["effect"] for one in cannot_say(outcome())] == ["friction_lag", "cushioning"]
    assert [one["effect"] for one in cannot_say(outcome("friction_lag"))] == ["cushioning"]


def test_a_machine_that_no_experiment_moves_is_to_be_moved_otherwise() -> None:
    ours, others = cannot_say(outcome()), cannot_say(outcome(machine="emps"))
    assert [one["effect"] for one in others] == [one["effect"] for one in ours]
    assert [one["experiment"] for one in ours] == ["pneumo experiment fast-reversals", "pneumo experiment full-strokes"]
    assert [one["experiment"] for one in others] == ["record fast reversals", "record full strokes"]
