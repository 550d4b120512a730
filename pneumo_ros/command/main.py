"""`pneumo VERB`: finds the verb, turns every failure into one sentence and an exit code."""

import os
import sys
from collections.abc import Sequence
from importlib import import_module
from types import ModuleType

from pneumo_ros import __version__
from pneumo_ros.command.arguments import Parser
from pneumo_ros.command.completing import answer
from pneumo_ros.command.console import Console, columns
from pneumo_ros.command.each_axis import run_verb
from pneumo_ros.command.rig_file import apply_rig
from pneumo_ros.environment import LIBRARIES, library_advice
from pneumo_ros.errors import DataError, PneumoError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.units import LINE, writing

VERBS = (
    "demo",
    "parts",
    "new",
    "import",
    "rig",
    "simulate",
    "identify",
    "compare",
    "diagnose",
    "add",
    "effects",
    "experiment",
    "commission",
    "tune",
    "export",
    "fleet",
    "view",
    "workbench",
    "completion",
)  # in the order help lists them; each is a module of the room `verb`

EXIT_CODES = """exit codes: 0 done, 1 done but outside what was asked, 2 wrong usage, 3 unreadable or unfit data,
4 numerical failure, 130 interrupted"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `pneumo` with `arguments` (those of the process, if None) and return the exit code."""
    answer(VERBS, lambda name, parser: _verb(name).add_arguments(parser))
    try:
        return _run(list(sys.argv[1:] if arguments is None else arguments))
    except PneumoError as error:
        return _fail(str(error), error.exit_code)
    except ModuleNotFoundError as error:
        name = (error.name or "").partition(".")[0]
        if name not in LIBRARIES:
            raise
        return _fail(library_advice([name]), UsageError.exit_code)
    except BrokenPipeError:  # the reader of stdout left, as `head` does; nothing more can be said there
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    except OSError as error:  # refused by the system: a folder that may not be read, a disk that fails
        where = f"{error.filename}: " if error.filename else ""
        return _fail(f"{where}{error.strerror or error}", DataError.exit_code)
    except KeyboardInterrupt:
        return _fail("interrupted", 130)


def _run(arguments: list[str]) -> int:
    if not arguments or arguments[0] in ("-h", "--help", "help"):
        print(help_text())
        return 0
    if arguments[0] == "--version":
        print(f"pneumo_ros {__version__}")
        return 0
    verb = _verb(arguments[0])
    parser = verb_parser(arguments[0], verb)
    options = parser.parse_strictly(arguments[1:])
    replaced = apply_rig(options)
    console = Console(getattr(options, "quiet", False), getattr(options, "json", None))
    if replaced:
        console.note(replaced)
    with writing(LINE):  # until a machine is chosen
        code: int = run_verb(arguments[0], verb, options, console)
    sys.stdout.flush()
    return code


def _verb(name: str) -> ModuleType:
    if name not in VERBS:
        kind = "option" if name.startswith("-") else "verb"
        allowed = ("--help", "--version") if kind == "option" else VERBS
        raise UsageError(f"{unknown_name(kind, name, allowed)} (see: pneumo --help)")
    return import_module(f"pneumo_ros.command.verb.{name}")


def verb_parser(name: str, verb: ModuleType) -> Parser:
    """The parser of one verb; its description is the module's docstring, its end are the EXAMPLES."""
    examples = "\n".join(("examples:", *(f"  {line}" for line in verb.EXAMPLES)))
    epilog = f"{examples}\n\n{EXIT_CODES}"
    parser = Parser(prog=f"pneumo {name}", description=(verb.__doc__ or "").strip(), epilog=epilog)
    verb.add_arguments(parser)
    return parser


def help_text() -> str:
    """What `pneumo` alone prints: every verb with one line."""
    rows = [(f"  {name}", (_verb(name).__doc__ or "").strip().splitlines()[0]) for name in VERBS]
    return "\n".join(
        (
            "usage: pneumo VERB [options]     pneumo VERB --help     pneumo --version",
            "",
            "A pneumatic axis: simulate it, compare its model with recordings, find what the model is missing.",
            "",
            columns(rows),
            "",
            EXIT_CODES,
        )
    )


def _fail(message: str, code: int) -> int:
    sys.stdout.flush()
    print(f"pneumo: error: {message}" if code != 130 else f"pneumo: {message}", file=sys.stderr)
    return code
