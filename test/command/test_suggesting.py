"""What a diagnosis says that its recordings cannot show."""

from types import SimpleNamespace
from typing import Any

from pneumo_ros.command.suggesting import cannot_say
from pneumo_ros.diagnose.steps import Step
from pneumo_ros.plant import load_model


def outcome(*added: str) -> Any:
    """As much of an outcome as is asked: a last round that shows neither of two effects, and what was added."""
    model = load_model("axis")
    last = Step(model, (), None, (), {}, {}, {"friction_lag": 0.0, "cushioning": 0.1})
    return SimpleNamespace(model=model, steps=(last,), added=[SimpleNamespace(effect=name) for name in added])


def test_an_effect_that_breakaways_showed_is_not_called_invisible() -> None:
    assert [one["effect"] for one in cannot_say(outcome())] == ["friction_lag", "cushioning"]
    assert [one["effect"] for one in cannot_say(outcome("friction_lag"))] == ["cushioning"]
