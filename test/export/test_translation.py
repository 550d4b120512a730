"""What an effect's Python may say, C says too, to the bit; what it cannot say is refused with its line."""

from pathlib import Path

import numpy as np
import pytest
from export.compiling import compiled, needs_compiler
from plant.catalogue import in_python

from pneumo_ros.errors import UsageError
from pneumo_ros.export import Exported, c_files
from pneumo_ros.plant import Model, load_model

SAID = {
    "augmented": "w = v\nw += 2.0 * y\nw *= y\nforce = w",
    "power": "force = y ** 3 + (y - 2.0) ** -2 + (y + 3.0) ** 0.5",
    "modulo": "force = y % 0.3 + (-y) % 0.3 + y // 0.3 + (v * y) // -0.7",
    "chain": "force = 1.0 if -0.5 < y < 0.5 < 2.0 else -1.0",
    "logic": "near = abs(y) < 0.4\nfast = not (v <= 0.1 or near)\nforce = 3.0 if near and not fast else 1.0 + near",
    "if_else": "if y > 0.2:\n    force = 1.0\nelif v > 0.0:\n    force = 2.0\nelse:\n    force = y",
    "swap": "a, b = y, v\na, b = b, a\nforce = a - 2.0 * b",
    "several": "low, high = ordered(y, v)\nforce = low + 10.0 * high",
    "early_return": "force = clipped(y) + clipped(v)",
    "keywords": "force = scaled(y, by=3.0)",
    "loop": "total = 0.0\nfor i in range(4):\n    total += i * y / (i + 1)\nforce = total + i",
    "range_of_two": "force = 0.0\nfor i in range(1, 5):\n    if i == 3:\n        continue\n    force += y / i",
    "while_": "n = 0\nx = abs(y)\nwhile x < 1.0 and n < 20:\n    x = 2.0 * x\n    n = n + 1\nforce = n + x",
    "whole_numbers": "force = 1 / 2 * y + int(v * 3.7) + round(y * 10.0) + float(2)",
    "elementary": "force = exp(y) + log(2.0 + y) + sin(9.0 * v) + cos(v) + atan(y) + tanh(v) + sqrt(abs(y)) + sign(y)",
    "of_math": "force = math.floor(4.0 * y) + math.exp(v) + math.pi + math.fabs(y) + math.hypot(y, v)",
    "several_least": "force = min(y, v, 0.1) + max(y, -0.2, v) + abs(-y)",
    "global_constant": "force = SIZE * y",
    "unused": "unneeded = 2.0 * y\nflag = y > 1.0\nforce = v",
    "words_of_c": "double, fabs, p = y, v, 2.0\nregister = abs(double) * p\nforce = register + fabs",
}
REFUSED = {
    "array": ("cells = np.zeros(3)\ncells[0] = y\nforce = cells[0]", "cells = np.zeros(3)"),
    "tuple_kept": ("pair = (y, v)\nforce = y", "pair = (y, v)"),
    "list": ("cells = [y, v]\nforce = y", "cells = [y, v]"),
    "value_of_or": ("force = y or v", "force = y or v"),
    "text": ("force = y if 'a' == 'b' else v", "force = y if 'a' == 'b' else v"),
    "step_of_range": ("force = 0.0\nfor i in range(0, 9, 2):\n    force = force + y", "for i in range(0, 9, 2):"),
}
_FILE = '''import math

import numpy as np

from pneumo_ros.plant.effect import Effect, Parameter, atan, cos, exp, log, sign, sin, sqrt, tanh

SIZE = 2.5


def ordered(a, b):
    return min(a, b), max(a, b)


def clipped(x):
    """Docstring."""
    if x > 0.3:
        return 0.3
    if x < -0.3:
        return -0.3
    return x


def scaled(x, by=2.0):
    return by * x


def sum_of(values):
    return values[0]


class OwnForce(Effect):
    """A force."""

    gain = Parameter(1.0, "1", "gain */ /* of the force")

    def equations(y, v, gain):
        """Docstring."""
{body}
        force = gain * force
        return force
'''


def machine(body: str, folder: Path) -> Model:
    """The EMPS with one effect of its own that computes `force` by `body`."""
    path = folder / "own.py"
    indented = "\n".join(" " * 8 + line for line in body.splitlines())
    path.write_text(_FILE.format(body=indented), encoding="utf-8")
    model = load_model("emps", effects_files=(str(path),))
    return model.with_effects(["own_force"])


@needs_compiler
def test_what_effects_may_say(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    states = random.uniform(-1.0, 1.0, (200, 2))
    for name, body in SAID.items():
        model = machine(body, tmp_path)
        wanted = in_python(model).derivatives(states, 0.0)[:, 1]
        ours = compiled(model, tmp_path)
        q, found = ours.defaults(), []
        for state in states:
            slopes = np.empty(3)
            ours.call("derivatives", np.array([0.0, *state]), ours.held(0.0), q, slopes)
            found.append(slopes[2])
        assert found == pytest.approx(wanted.tolist(), rel=1e-14), name


@pytest.mark.parametrize("name", REFUSED)
def test_what_c_cannot_say_is_refused_with_its_line(name: str, tmp_path: Path) -> None:
    body, line = REFUSED[name]
    model = machine(body, tmp_path)
    with pytest.raises(UsageError) as refused:
        c_files(Exported(model), "own.h")
    number = (tmp_path / "own.py").read_text().splitlines().index(" " * 8 + line) + 1
    sentence = str(refused.value)
    place = f"{tmp_path / 'own.py'}, line {number}: `{line}`"
    assert sentence.startswith(f"effect own_force cannot be exported to C: {place}")
    assert sentence.endswith("rewrite that line")


def test_a_refused_line_of_a_helper_is_found(tmp_path: Path) -> None:
    model = machine("force = clipped(sum_of((y, v)))", tmp_path)
    with pytest.raises(UsageError, match=r"line 28: `return values\[0\]`"):
        c_files(Exported(model), "own.h")
