"""Every loop has a bound: `while True` is allowed only where its end is explained."""

import ast
from pathlib import Path

import pneumo_ros

PACKAGE = Path(pneumo_ros.__file__).parent
ENDLESS = {
    "axis/simulator/compiling.py": "a worker thread: it ends when no model is wanted any more",
    "ros/controller/action.py": "the event loop of a goal: it ends when the goal is cancelled, or with its time",
}


def endless(path: Path) -> list[int]:
    """Lines of loops whose condition is a constant."""
    found = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    return [node.lineno for node in found if isinstance(node, ast.While) and isinstance(node.test, ast.Constant)]


def test_no_loop_is_endless_but_those_listed() -> None:
    lines = {path.relative_to(PACKAGE).as_posix(): endless(path) for path in sorted(PACKAGE.rglob("*.py"))}
    assert {name for name, found in lines.items() if found} == set(ENDLESS)
    assert all(len(lines[name]) == 1 for name in ENDLESS)
