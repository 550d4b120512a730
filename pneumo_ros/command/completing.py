"""What a shell asks when Tab is pressed: verbs, options, and the names that an argument may have.

The shell's script (`pneumo completion bash`) starts `pneumo` with _ARGCOMPLETE and COMP_LINE set; argcomplete answers.
"""

import argparse
import os
from collections.abc import Callable, Sequence

from pneumo_ros.command.arguments import Parser

Names = Callable[[], Sequence[str]]


def answer(verbs: Sequence[str], fill: Callable[[str, argparse.ArgumentParser], None]) -> None:
    """Write what completes the line in COMP_LINE, and leave the program; return at once where no shell asks.

    `fill` adds the arguments of a verb to a parser; that of a verb that the line does not name is left empty.
    """
    if "_ARGCOMPLETE" not in os.environ:
        return
    import argcomplete
    from argcomplete.completers import FilesCompleter

    typed = os.environ.get("COMP_LINE", "").split()
    top = Parser(prog="pneumo", description=None)
    choices = top.add_subparsers(parser_class=argparse.ArgumentParser)
    for verb in verbs:
        parser = choices.add_parser(verb)
        if verb in typed:
            fill(verb, parser)
            for action in parser._actions:
                action.completer = _completer(verb, action.dest) or FilesCompleter()  # type: ignore[attr-defined]
    argcomplete.autocomplete(top, always_complete_options="long")


def _completer(verb: str, argument: str) -> Callable[..., Sequence[str]] | None:
    """What names an argument of a verb may have besides files; None where files are all."""
    names: dict[tuple[str, str], Names] = {
        ("effects", "name"): _effects, ("add", "named"): _effects, ("experiment", "separate"): _effects,
        ("parts", "what"): _parts, ("new", "cylinder"): _parts, ("new", "valve"): _parts,
        ("experiment", "name"): _experiments, ("tune", "law"): _laws,
        ("export", "format"): lambda: ("c", "fmu", "mjcf"), ("completion", "shell"): lambda: ("bash", "zsh", "fish"),
    }  # fmt: skip
    machines = argument == "model" or (verb, argument) == ("export", "machine")
    found = _machines if machines else names.get((verb, argument))
    if found is None:
        return None
    with_files = machines or (verb, argument) in (("add", "named"), ("experiment", "name"))
    return lambda prefix, **_: [*found(), *(_files(prefix) if with_files else ())]


def _files(prefix: str) -> Sequence[str]:
    from argcomplete.completers import FilesCompleter

    return list(FilesCompleter()(prefix))


def _effects() -> Sequence[str]:
    from pneumo_ros.plant.library import Library

    return Library().names()


def _machines() -> Sequence[str]:
    from pneumo_ros.plant.machine_file import shipped_machines

    return shipped_machines()


def _parts() -> Sequence[str]:
    from pneumo_ros.parts.shelf import load_shelf

    return sorted(load_shelf().parts)


def _experiments() -> Sequence[str]:
    from pneumo_ros.experiment.catalogue import EXPERIMENTS

    return sorted(EXPERIMENTS)


def _laws() -> Sequence[str]:
    from pneumo_ros.control.laws import LAWS

    return sorted(LAWS)
