"""A machine as one Modelica package: its effects as functions, its states and parameters as a model."""

import math
import re

from pneumo_ros import __version__
from pneumo_ros.errors import UsageError
from pneumo_ros.export.machine import Exported, Variable
from pneumo_ros.export.modelica_code import functions_text, word
from pneumo_ros.export.refusal import refusal
from pneumo_ros.export.signature import InexpressibleError

MODEL = "Axis"
_UNIT = re.compile(r"[A-Za-z0-9./()]+")


def modelica_text(machine: Exported) -> str:
    """The text of the package; the model in it is `MODEL`.

    Raises UsageError for effects that have memory from step to step, which Modelica's continuous time has not, and,
    with effect, file and line, for what Modelica cannot say.
    """
    _check_continuous(machine)
    roots = ["derivatives", "observation"]
    try:
        lines, widths = functions_text(machine.functions, roots)
    except InexpressibleError as problem:
        tree = machine.functions[problem.args[-1]]
        raise refusal(machine.model.composition.effects, tree, problem, "Modelica") from problem
    package = word(machine.prefix)
    head = [
        f"package {package}",
        f'  "Machine {machine.model.name}, written by pneumo export {__version__}; SI units"', "",
    ]  # fmt: skip
    whole = [*head, *_indented(lines), *_indented(_model(machine, widths)), f"end {package};"]
    return "\n".join(line.rstrip() for line in whole) + "\n"


def _check_continuous(machine: Exported) -> None:
    for effect in machine.model.composition.effects:
        if "advance" in effect.functions and not effect.invariant:
            raise UsageError(
                f"effect {effect.name} sets {effect.functions['advance'].writes[0]} after each step, and a Modelica "
                f"model in continuous time has no steps: export an fmu, or a machine file without {effect.name}"
            )


def _model(machine: Exported, widths: dict[str, int]) -> list[str]:
    states = [word(one.name) for one in machine.states]
    parameters = [_dotted(one.name) for one in machine.parameters]
    seen = [one for one in machine.outputs if one.name in machine.model.composition.observed]
    arguments = {name: [a.arg for a in machine.functions[name].args.args] for name in ("derivatives", "observation")}
    known = {one.name: word(one.name) for one in (*machine.states, *machine.inputs)} | {"t": "time"}
    known |= {one.name.replace(".", "__"): name for one, name in zip(machine.parameters, parameters, strict=True)}
    rates = [f"rate_{name}" for name in states] + [f"slope_{k}" for k in range(widths["derivatives"] - len(states))]
    outputs = [word(one.name) for one in seen]
    if widths["observation"] != len(outputs):
        outputs += [f"unread_{k}" for k in range(widths["observation"] - len(outputs))]
    calls = {name: f"{name}({', '.join(known[a] for a in given)})" for name, given in arguments.items()}
    lines = [f"  parameter {_declared(one, name)};" for one, name in zip(machine.parameters, parameters, strict=True)]
    lines += [f"  input {_declared(one, word(one.name), start=False)};" for one in machine.inputs]
    lines += [f"  {_state(one)};" for one in machine.states]
    lines += [f"  output {_declared(one, word(one.name), start=False)};" for one in seen]
    hidden = [*rates, *outputs[len(seen) :]]
    lines += ["protected", *(f"  Real {name};" for name in hidden)]
    followers = [one for one in machine.states if _follows_state(one)]
    lines += ["initial equation"] * bool(followers)
    lines += [f"  {word(one.name)} = {word(one.follows)};" for one in followers]
    lines += ["equation", f"  ({', '.join(rates)}) = {calls['derivatives']};"]
    lines += [f"  der({name}) = rate_{name};" for name in states]
    lines += [f"  ({', '.join(outputs)}) = {calls['observation']};"] if outputs else []
    return [f"model {MODEL}", *lines, f"end {MODEL};"]


def _dotted(name: str) -> str:
    return word(name.replace(".", "__"))


def _declared(one: Variable, name: str, *, start: bool = True) -> str:
    """A variable with unit, range, value and meaning."""
    value = f" = {one.start!r}" if start else ""
    return f"Real {name}{_attributes(_unit(one), *_limits(one))}{value} {_quoted(one.meaning)}"


def _state(one: Variable) -> str:
    """A state: it starts with a number, a parameter, or, by an initial equation, as another state."""
    start = _dotted(one.follows) if "." in one.follows else repr(one.start)
    begin = [] if _follows_state(one) else [f"start = {start}", "fixed = true"]
    return f"Real {word(one.name)}{_attributes(_unit(one), *begin)} {_quoted(one.meaning)}"


def _follows_state(one: Variable) -> bool:
    return bool(one.follows) and "." not in one.follows


def _unit(one: Variable) -> str:
    unit = one.unit.replace(" ", ".")
    return f'unit = "{unit}"' if unit != "1" and _UNIT.fullmatch(unit) and "sqrt" not in unit else ""


def _limits(one: Variable) -> list[str]:
    pairs = (("min", one.low), ("max", one.high))
    return [f"{key} = {value!r}" for key, value in pairs if math.isfinite(value)]


def _attributes(*given: str) -> str:
    kept = [one for one in given if one]
    return f"({', '.join(kept)})" if kept else ""


def _quoted(text: str) -> str:
    return '"' + " ".join(text.replace("\\", "/").replace('"', "'").split()) + '"'


def _indented(lines: list[str]) -> list[str]:
    return [f"  {line}" for line in lines]
