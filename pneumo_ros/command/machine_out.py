"""The options --out and --overwrite of verbs that write a machine file."""

import argparse

from pneumo_ros.errors import UsageError
from pneumo_ros.files import check_writable


def add_machine_file(parser: argparse.ArgumentParser, what: str, *, required: bool = False) -> None:
    """--out and --overwrite; `what` is the help of --out."""
    parser.add_argument("--out", metavar="MODEL", required=required, help=what)
    parser.add_argument("--overwrite", action="store_true", help="--out may replace a file")


def check_machine_file(options: argparse.Namespace) -> None:
    """UsageError, before any work, where --out cannot be written, or exists without --overwrite."""
    if options.out is None:
        if options.overwrite:
            raise UsageError("--overwrite goes with --out MODEL")
        return
    if check_writable(options.out).exists() and not options.overwrite:
        raise UsageError(f"{options.out} exists; name another file, or add --overwrite")
