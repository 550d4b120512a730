"""Print the script that lets bash, zsh or fish complete verbs, options, effects, parts and machine files.

Write it once to where the shell looks for completions; a new shell then knows them.
"""

import argparse

from pneumo_ros.command.arguments import add_output
from pneumo_ros.command.console import Console
from pneumo_ros.environment import require_libraries
from pneumo_ros.errors import UsageError
from pneumo_ros.nearest import unknown_name

SHELLS = ("bash", "zsh", "fish")

EXAMPLES = (
    "pneumo completion bash > ~/.local/share/bash-completion/completions/pneumo",
    "pneumo completion zsh > ~/.zfunc/_pneumo       # a folder of fpath",
    "pneumo completion fish > ~/.config/fish/completions/pneumo.fish",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """SHELL and the common options."""
    parser.add_argument("shell", metavar="bash|zsh|fish", help="the shell to write for")
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Print the script."""
    if options.shell not in SHELLS:
        raise UsageError(unknown_name("shell", options.shell, SHELLS))
    require_libraries(["argcomplete"])
    from argcomplete.shell_integration import shellcode

    script = shellcode(["pneumo"], shell=options.shell)
    console.say(script)
    console.json({"schema_version": 1, "shell": options.shell, "script": script})
    return 0
