"""Effects as a user writes them: their text, and the axis with these effects."""

from pathlib import Path

from plant.catalogue import in_python

from pneumo_ros.plant import Model, load_model

AXIS = load_model("axis")
HEAD = "from pneumo_ros.plant.effect import Effect, Parameter, State\n"


def composed(folder: Path, body: str, *names: str, base: tuple[str, ...] = AXIS.effects) -> Model:
    """The axis with effects from a file of that text, in plain Python."""
    path = folder / "own.py"
    path.write_text(HEAD + body)
    return in_python(load_model("axis", [path]).with_effects([*base, *names]))


def one(reads: str, *lines: str, name: str = "Own", more: str = "") -> str:
    """Text of an effect: class, inputs, and the lines of its equations; the last one names its outputs."""
    body = "\n".join(f"        {line}" for line in lines)
    return f'\nclass {name}(Effect):\n    """An effect for a test."""\n{more}\n    def equations({reads}):\n{body}\n'


def seen(model: Model, signal: str, voltage: float = 3.0, **state: float) -> float:
    """An observed signal at one instant."""
    return float(model.outputs(model.state(**state), voltage)[signal][0])
