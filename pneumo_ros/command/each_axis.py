"""A verb for a machine of several axes: it runs for one axis after another, and the results are one."""

import argparse
import tempfile
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import chosen_machine
from pneumo_ros.command.console import Console, Progress
from pneumo_ros.command.line_fitting import with_line
from pneumo_ros.command.machine_out import check_machine_file
from pneumo_ros.command.recordings import unfolded
from pneumo_ros.errors import DataError, NumericalError
from pneumo_ros.files import check_writable, write_whole

if TYPE_CHECKING:
    from pneumo_ros.command.together import Together
    from pneumo_ros.multiaxis import Machine
    from pneumo_ros.plant import Model

VERBS = ("identify", "compare", "diagnose")  # that judge axes one by one
KEEPING = ("add",)  # that change one axis of a machine, FILE:AXIS, and write the whole machine
_FILES = ("report", "figures", "series")  # options that name a file: with several axes, one for each


def run_verb(name: str, verb: ModuleType, options: argparse.Namespace, console: Console) -> int:
    """Run the verb, once for each axis where the machine has several; returns the exit code, the worst of all."""
    machine = chosen_machine(options) if name in VERBS else None
    if name in KEEPING:
        from pneumo_ros.plant.axes_section import place_of

        path, axis = place_of(options.model)
        if axis is not None:
            return run_within(verb, Path(path), axis, options, console)
    code: int = verb.run(options, console) if machine is None else run_each(verb, machine, options, console)
    return code


def run_within(verb: ModuleType, path: Path, axis: str, options: argparse.Namespace, console: Console) -> int:
    """Run the verb for one axis of the machine at `path`, and write the machine with what it made of that axis."""
    from pneumo_ros.command.together import Together
    from pneumo_ros.multiaxis import load_machine
    from pneumo_ros.plant import load_model

    load_model(options.model, tuple(options.effects))  # says what is wrong with the file or the axis
    check_machine_file(options)
    machine, above = load_machine(path, tuple(options.effects)), (options.namespace or "").strip("/").rpartition("/")[0]
    with tempfile.TemporaryDirectory() as folder:
        inner = WithinConsole(console, folder)
        one = {**vars(options), "out": str(Path(folder) / f"{axis}.yaml")}
        one["together"] = Together(machine, argparse.Namespace(**{**vars(options), "namespace": above or None}))
        code: int = verb.run(argparse.Namespace(**one), inner)
        _write(machine.with_axes(_written(argparse.Namespace(**one), axis)), options, console)
        console.json(inner.result | {"machine_file": options.out})
        console.next(inner.typed.replace(one["out"], f"{options.out}:{axis}"))
    return code


class AxisConsole(Console):
    """Output of a verb for one axis: notes name it, and its JSON is kept in `result`."""

    def __init__(self, outer: Console, axis: str, hidden: str) -> None:
        """Print through `outer`, but for notes on files in the folder `hidden`, which nobody is to look for."""
        self.outer, self.axis, self.hidden = outer, axis, hidden
        self.result: dict[str, Any] = {}

    def say(self, text: str = "") -> None:
        """A result, as it is: a heading names the axis."""
        self.outer.say(text)

    def note(self, text: str) -> None:
        """A message, behind the axis."""
        if self.hidden not in text:
            self.outer.note(f"{self.axis}/: {text}")

    def next(self, words: str) -> None:
        """Nothing: what to type next is said once, for the machine."""

    def progress(self, title: str) -> Progress:
        """Progress behind the axis."""
        return self.outer.progress(f"{self.axis}/: {title}")

    def json(self, data: dict[str, Any]) -> None:
        """Keep the results."""
        self.result = data


class WithinConsole(AxisConsole):
    """Output of a verb for the one axis that was named: as it is, but for its JSON and what to type next."""

    def __init__(self, outer: Console, hidden: str) -> None:
        super().__init__(outer, "", hidden)
        self.typed = ""

    def note(self, text: str) -> None:
        """A message, but for those on hidden files."""
        if self.hidden not in text:
            self.outer.note(text)

    def progress(self, title: str) -> Progress:
        """Progress, as it is."""
        return self.outer.progress(title)

    def next(self, words: str) -> None:
        """Keep what to type next."""
        self.typed = words


def run_each(verb: ModuleType, machine: "Machine", options: argparse.Namespace, console: Console) -> int:
    """Judge the axes one by one; an axis whose recordings cannot be used is named, and the others are judged."""
    from pneumo_ros.command.together import Together

    if hasattr(options, "overwrite"):  # a verb that writes a machine file
        check_machine_file(options)
    results: dict[str, Any] = {}
    models: dict[str, Model] = {}
    codes: list[int] = []
    together = Together(machine, options)
    with tempfile.TemporaryDirectory() as folder:
        for axis in machine.axes:
            inner = AxisConsole(console, axis, folder)
            one = _options(options, together, axis, Path(folder))
            console.say(f"{axis}/")
            try:
                codes.append(verb.run(one, inner))
                results[axis] = inner.result | ({"machine_file": options.out} if "machine_file" in inner.result else {})
            except (DataError, NumericalError) as problem:
                console.say(f"{problem}")
                codes.append(problem.exit_code)
                results[axis] = {"error": str(problem)}
            console.say()
            models |= _written(one, axis)
    found = machine.with_axes(models)
    result = {"schema_version": 1, "model": machine.name, "axes": results} | _together(results)
    console.say("\n".join(f"{axis}/: {_headline(one)}" for axis, one in results.items()))
    if fitted := _fitted(verb, options):
        found, line = with_line(found, options, unfolded(fitted), console)
        result |= line
    _write(found, options, console)
    console.json(result)
    return max(codes)


def _fitted(verb: ModuleType, options: argparse.Namespace) -> list[str]:
    """The recordings to which the verb fits axes, and so their line; none where it fits nothing."""
    if verb.__name__.endswith(".identify"):
        return list(options.bags)
    return list(getattr(options, "fit", None) or (options.bags if getattr(options, "refit", False) else []))


def _options(options: argparse.Namespace, together: "Together", axis: str, folder: Path) -> argparse.Namespace:
    """The options of one axis: its machine, its namespace, and files of its own."""
    from pneumo_ros.command.axes_playing import namespace_of

    own = {key: list(value) if isinstance(value, list) else value for key, value in vars(options).items()}
    own |= {"model": f"{options.model}:{axis}", "namespace": namespace_of(options.namespace, axis)}
    own["together"] = together
    for key in _FILES:
        if own.get(key):
            path = Path(str(own[key]))
            own[key] = str(path.with_name(f"{path.stem}_{axis}{path.suffix}"))
    if own.get("out"):
        own["out"] = str(folder / f"{axis}.yaml")
    return argparse.Namespace(**own)


def _written(options: argparse.Namespace, axis: str) -> "dict[str, Model]":
    """The machine file that the verb wrote for one axis, if it did."""
    from pneumo_ros.plant import load_model

    out = getattr(options, "out", None)
    return {axis: load_model(out, tuple(options.effects))} if out and Path(out).exists() else {}


def _write(machine: "Machine", options: argparse.Namespace, console: Console) -> None:
    from pneumo_ros.multiaxis import machine_text

    if getattr(options, "out", None):
        write_whole(check_writable(options.out), machine_text(machine))
        console.note(f"Machine file of all axes written to {options.out}")


def _together(results: dict[str, Any]) -> dict[str, Any]:
    """What holds for the machine: the worst verdict of a diagnosis."""
    from pneumo_ros.diagnose.outcome import ADEQUATE, FOUND, UNKNOWN

    order = (ADEQUATE, FOUND, UNKNOWN)
    found = [one["verdict"] for one in results.values() if one.get("verdict") in order]
    return {"verdict": max(found, key=order.index)} if found else {}


def _headline(result: dict[str, Any]) -> str:
    return str(result.get("error") or result.get("headline") or "done")
