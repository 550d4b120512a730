"""Turn published tables (CSV, MAT, Parquet, NPZ, JSON, each also .gz) into recordings, by a map of their columns.

pneumo import run.csv --guess --map map.yaml         writes a first map; check each line of it
pneumo import run.csv --map map.yaml --out bag       one recording
pneumo import *.csv --map map.yaml --out bags        one for each table, in a folder

Exit code 1 when a table could not be imported, or a guess lacks what a recording needs.
"""
# ruff: noqa: N999 - the verb is called import

import argparse
import shlex
from pathlib import Path
from typing import Any

from pneumo_ros.command.arguments import add_output
from pneumo_ros.command.console import Console
from pneumo_ros.command.importing_text import guess_json, guess_text, imported_text, summary
from pneumo_ros.command.targets import targets
from pneumo_ros.errors import PneumoError, UsageError
from pneumo_ros.files import check_writable, write_whole

NAMED = 4  # tables that the next command line names; of more, the first one

EXAMPLES = (
    "pneumo import run.csv --guess --map map.yaml      # then look at map.yaml",
    "pneumo import run*.csv --map map.yaml --out bags",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """TABLE..., the map, where to write, and the common options."""
    parser.add_argument(
        "tables", nargs="+", metavar="TABLE", help="files with a column of time and one for each signal"
    )
    parser.add_argument("--map", metavar="MAP.yaml", required=True, help="what the columns are; with --guess: written")
    parser.add_argument(
        "--out", metavar="BAG", help="new recording; for several tables, the folder of their recordings"
    )
    parser.add_argument(
        "--guess", action="store_true", help="write a map from headings, units and ranges of the first table"
    )
    parser.add_argument(
        "--rate", type=float, metavar="HZ", help="of the recording, 20 to 20000 (default: that of the rows)"
    )
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Guess the map, or import every table."""
    from pneumo_ros.tables.even import check_rate

    check_rate(options.rate)
    if options.guess:
        return _guess(options, console)
    if options.out is None:
        raise UsageError(
            "--out is missing: name the recording to write, such as --out bag; or --guess to write the map first"
        )
    return _import(options, console)


def _guess(options: argparse.Namespace, console: Console) -> int:
    """Write the map of the first table."""
    from pneumo_ros.tables.guess import guess
    from pneumo_ros.tables.guess_text import map_text
    from pneumo_ros.tables.reading import read_table

    path = check_writable(options.map)
    if path.exists():
        raise UsageError(
            f"{path} exists and is not overwritten; name another file, or leave out --guess to import with it"
        )
    if options.out is not None or options.rate is not None:
        raise UsageError(
            "--guess writes the map only; leave out --out and --rate, check the map, then import without --guess"
        )
    table = read_table(options.tables[0])
    for note in table.notes:
        console.note(f"{table.path.name}: {note}")
    found = guess(table)
    write_whole(path, map_text(found, table.path.name))
    console.say(f"{table.path.name}: {len(table)} rows, {len(table.columns)} columns\n{guess_text(found)}")
    console.say(f"Map written to {path}; {'check' if found.complete else 'complete'} it")
    console.json({"schema_version": 1, "map": path, "table": table.path, "guess": guess_json(found)})
    few = len(options.tables) <= NAMED
    named = shlex.join(options.tables) if few else f"{shlex.quote(options.tables[0])} TABLE..."
    console.next(f"import {named} --map {shlex.quote(str(path))} --out {'bag' if len(options.tables) == 1 else 'bags'}")
    return 0 if found.complete else 1


def _import(options: argparse.Namespace, console: Console) -> int:
    """Write a recording of each table; those that cannot be used are passed over, unless it is the only one."""
    from pneumo_ros.tables.map_file import load_map

    plan = load_map(options.map)
    goals = targets(options.tables, options.out)
    done, problems = list[dict[str, Any]](), dict[str, str]()
    for table, path in goals.items():
        try:
            done.append(_one(table, path, plan, options, console))
        except PneumoError as problem:
            if not done and len(problems) + 1 == len(goals):  # none could be imported
                raise
            problems[table] = str(problem)
            console.note(f"Passed over: {problem}")
    console.json({"schema_version": 1, "imported": done, "passed_over": problems})
    look = str(done[0]["bag"] if len(goals) == 1 else options.out)
    console.next(f"view {shlex.quote(look)}")
    return int(bool(problems))


def _one(table: str, path: Path, plan: Any, options: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Import one table."""
    from pneumo_ros.tables.importing import imported, write_bag
    from pneumo_ros.tables.reading import read_table

    found = imported(read_table(table), plan, options.rate)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bag(found, path)
    told = summary(found, path)
    console.say(imported_text(told, found.clock.words()))
    for note in found.notes:
        console.note(f"{found.table.path.name}: {note}")
    return told
