"""Open the workbench: a local web page to see where a model fails, tick an effect, and watch the error fall.

The page is served on this computer only, at the printed address with a secret token. Ctrl-C ends it and all that it
computes. BAG may be a folder of recordings; recordings whose names begin with hold are held out. Everything that the
page computes is a verb of this command, and it shows the command line.
"""

import argparse
import contextlib
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

from pneumo_ros.command.arguments import add_model, add_output, add_recordings
from pneumo_ros.command.console import Console
from pneumo_ros.command.recordings import read_options
from pneumo_ros.environment import require_libraries

PORT = 8765

EXAMPLES = (
    "pneumo workbench runs --model my.yaml",
    "pneumo workbench                        # only what the shipped machine does",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """BAG..., --port, how to read recordings, and the machine file."""
    parser.add_argument("bags", nargs="*", metavar="BAG", help="recordings, or folders of recordings")
    parser.add_argument("--port", type=int, default=PORT, metavar="N", help=f"default: {PORT}; 0: any free one")
    add_recordings(parser, cut=False)
    add_model(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Serve until Ctrl-C."""
    require_libraries(("dash", "plotly", "waitress"))
    from pneumo_ros.workbench.desk import Given
    from pneumo_ros.workbench.serve import serve

    rig = str(Path(options.rig_file).resolve()) if options.rig_file else ""
    given = Given(tuple(options.bags), read_options(options), options.model, tuple(options.effects), rig)

    def ready(address: str) -> None:
        console.say(address)
        console.json({"schema_version": 1, "address": address})
        sys.stdout.flush()
        console.note("Open this address in a browser on this machine; Ctrl-C ends the workbench.")

    with _ending(), contextlib.suppress(KeyboardInterrupt):
        serve(given, options.port, ready)
    console.note("The workbench has ended.")
    return 0


@contextlib.contextmanager
def _ending() -> Iterator[None]:
    """SIGINT and SIGTERM interrupt, also where a shell started this in the background and had SIGINT ignored."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = {number: signal.signal(number, signal.default_int_handler) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
