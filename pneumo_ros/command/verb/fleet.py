"""Examine recordings of many machines: what drifted, and which effect appeared when.

FOLDER holds a folder for each machine. That folder holds recordings, which form a campaign for each day, or folders of
recordings, each of which is a campaign. A campaign with held-out recordings (names that begin with hold) is diagnosed,
and its parameters are refitted with the effects that were found; any other is identified from constant voltages. Then
the parameters are compared over time, with their intervals, and each effect is dated by when it was found first. A
machine.yaml in the folder of a machine is its model; without it, --model is.

Campaigns are examined in parallel, on processes or a Dask cluster. --results keeps each result when it is ready: the
same command continues after an interruption, and later examines only new campaigns.
"""

import argparse
import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.arguments import add_executor, add_model, add_output, chosen_model, model_for_workers
from pneumo_ros.command.console import Console, plain
from pneumo_ros.command.fleet_text import text
from pneumo_ros.command.reporting import add_report, prepare_report

if TYPE_CHECKING:
    from pneumo_ros.fleet.folder import Campaign
    from pneumo_ros.sweep import Journal

EXAMPLES = (
    "pneumo fleet rigs --results nightly --report fleet.html",
    "pneumo fleet rigs --results nightly --identify-only",
)  # parsed by a test


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """FOLDER, how to compute, and the common options."""
    parser.add_argument("folder", metavar="FOLDER", help="with a folder for each machine")
    add_executor(parser)
    parser.add_argument("--results", metavar="FILE", help="keep what is computed, and do not compute it again")
    parser.add_argument("--identify-only", action="store_true", help="do not look for effects: much faster")
    parser.add_argument(
        "--rig", dest="rig_file", metavar="RIG.yaml", help="wiring of machines without a rig.yaml of their own"
    )
    add_model(parser)
    add_report(parser)
    add_output(parser)


def run(options: argparse.Namespace, console: Console) -> int:
    """Find, examine, compare, print; 1 when a campaign could not be examined."""
    from contextlib import ExitStack

    from pneumo_ros.fleet.folder import campaigns
    from pneumo_ros.fleet.history import history
    from pneumo_ros.report.fleet import fleet_report

    found, passed = campaigns(options.folder)
    for reason in passed.values():
        console.note(f"Passed over: {reason}")
    options.bags = [str(path) for campaign in found for path in campaign.paths]
    report = prepare_report(options)
    chosen_model(options)  # a wrong machine file is reported before anything is computed
    with ExitStack() as stack:
        journal = stack.enter_context(_journal(options)) if options.results else None
        examined = _examined(found, options, console, journal)
    machines = history(examined)
    result: dict[str, Any] = plain(
        {"schema_version": 1, "folder": options.folder, "machines": machines, "passed_over": passed}
        | {"provenance": report.origin()}
    )
    console.say(text(result))
    console.json(result)
    report.publish(console, lambda origin: fleet_report(result, origin))
    console.next(f"fleet {shlex.quote(str(options.folder))} --report fleet.html   # every machine over time")
    return int(any(one["problem"] for one in examined))


def _examined(
    found: "list[Campaign]", options: argparse.Namespace, console: Console, journal: "Journal | None"
) -> list[dict[str, Any]]:
    """Every campaign with what was found, in the order of machines and time."""
    from pneumo_ros.fleet.examine import examine
    from pneumo_ros.sweep import open_pool, sweep

    model, effects = model_for_workers(options)
    by_key = {campaign.fingerprint: campaign for campaign in found}
    rig = str(Path(options.rig_file).resolve()) if options.rig_file else ""
    jobs = {
        key: (_paths(c), _model(c, model), effects, not options.identify_only, _rig(c, rig))
        for key, c in by_key.items()
    }
    results = {}
    with open_pool(options.executor) as pool, console.progress("Examining") as progress:
        for done in sweep(examine, jobs, pool, journal):
            results[done.key] = done
            if done.problem:
                console.note(f"{by_key[done.key].key} is left out: {done.problem}")
            progress(len(results) / len(jobs))
    empty: dict[str, Any] = {"parameters": {}, "added": [], "verdict": None, "undetermined": {}, "passed_over": {}}
    return [
        {"machine": c.machine, "campaign": c.name, "date": c.date, "problem": results[key].problem}
        | (results[key].result or empty)
        for key, c in by_key.items()
    ]


def _paths(campaign: "Campaign") -> list[str]:
    return [str(path.resolve()) for path in campaign.paths]


def _rig(campaign: "Campaign", other: str) -> str:
    return other if campaign.rig_file is None else str(campaign.rig_file.resolve())


def _model(campaign: "Campaign", other: str) -> str:
    """The machine file of a campaign: its own, else that of its rig file."""
    from pneumo_ros.command.rig_file import read_rig

    if campaign.machine_file is not None:
        return str(campaign.machine_file.resolve())
    named = read_rig(str(campaign.rig_file)).machine if campaign.rig_file else ""
    return str(Path(named).resolve()) if named and Path(named).is_file() else named or other


def _journal(options: argparse.Namespace) -> "Journal":
    """The file of results, for this model, these effects, and this version of the package."""
    from pneumo_ros import __version__
    from pneumo_ros.plant.machine_file import read_machine
    from pneumo_ros.sweep import Journal

    texts = [Path(path).read_text(encoding="utf-8", errors="replace") for path in options.effects]
    purpose = {"version": __version__, "model": read_machine(options.model)[1], "effects": texts}
    if options.rig_file:
        purpose["rig"] = Path(options.rig_file).read_text(encoding="utf-8")
    return Journal(options.results, purpose | {"identify_only": options.identify_only})
