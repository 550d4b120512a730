"""The verbs that a button runs: the same command lines that a user could type."""

import shlex
from collections.abc import Sequence
from dataclasses import dataclass

from pneumo_ros.errors import UsageError
from pneumo_ros.plant.axes_section import place_of
from pneumo_ros.reading.read import ReadOptions
from pneumo_ros.workbench.bags import Bag, reading_options
from pneumo_ros.workbench.job import Line

IMPORTING = "Importing"
_EFFECT_LINE, _COMPARE_LINE, _DIAGNOSE_LINE = 6.0, 1.0, 12.0  # shares of a job's time


@dataclass(frozen=True)
class Bench:
    """Arguments of every verb: the recordings, how to read them, the machine file and files of effects."""

    bags: tuple[Bag, ...]
    how: ReadOptions
    machine: str
    effects: tuple[str, ...]
    compared: bool = True  # whether the machine was compared with the recordings
    rig: str = ""  # its rig file, with which it moves

    def paths(self, *roles: str) -> list[str]:
        """Paths of the usable recordings in these roles."""
        return [bag.path for bag in self.bags if bag.role in roles and not bag.problem]

    def used(self) -> list[Bag]:
        """The recordings that are fitted or held out."""
        return [bag for bag in self.bags if bag.role != "out" and not bag.problem]

    def options(self, machine: str) -> list[str]:
        """--model, --effects, and how to read and cut."""
        effects = [word for path in self.effects for word in ("--effects", path)]
        cuts = [word for bag in self.used() for word in bag.cut_options()]
        return ["--model", machine, *effects, *reading_options(self.how), *cuts]


@dataclass(frozen=True)
class Plan:
    """Verbs to run, and the names of the files they write; `machine` is empty when they make none."""

    title: str
    label: str
    lines: tuple[Line, ...]
    bags: tuple[str, ...]  # names of the compared recordings, in this order
    compared: str  # stem of the comparison's files
    machine: str = ""
    recordings: str = ""  # folder of new recordings
    made: str = ""  # stem of JSON and report of the verb that makes the machine
    before: str = ""  # stem of the comparison of the machine that this one is made from, if that lacked one
    map: str = ""  # of the table that is imported
    guess: str = ""  # the table whose columns are guessed

    def shown(self) -> tuple[str, ...]:
        """The command lines, to be typed."""
        return tuple(shlex.join(["pneumo", *line.arguments]) for line in self.lines)

    def line_of(self, stem: str) -> str:
        """The command line, to be typed, that writes the comparison `stem`."""
        pairs = zip(self.lines, self.shown(), strict=True)
        return next((shown for line, shown in pairs if f"{stem}.json" in line.arguments), "")


def live_options(how: ReadOptions, rig: str) -> list[str]:
    """How the rig is wired, for verbs that move it: its file, or the words with which its recordings are read."""
    if rig:
        return ["--rig", rig]
    given = {"--joint": how.joint, "--read-as": ",".join(how.words)}
    return [word for key, value in given.items() if value for word in (key, value)]


def compare_plan(bench: Bench, number: int) -> Plan:
    """Compare the machine with all recordings in use; UsageError when there are none."""
    line, bags = _compare(bench, bench.machine, number)
    return Plan("Comparing", "", (line,), bags, f"compared_{number}")


def refit_plan(bench: Bench, effects: Sequence[str], machine: str, number: int) -> Plan:
    """Add `effects` and refit, or only refit without any; write `machine`, and compare it.

    The machine before is compared, too, if it was not: to see before and after in one plot.
    """
    fit, held, made = bench.paths("fit"), bench.paths("hold"), f"made_{number}"
    if not fit:
        raise UsageError("no recording is marked 'fit'; mark one, then press Refit again")
    files = ["--out", machine, "--json", f"{made}.json"]
    if effects:
        holdout = ["--holdout", *held] if held else []
        words = ["add", *effects, *fit, *holdout, *bench.options(bench.machine), *files, "--report", f"{made}.html"]
        label, axis = f"+ {', '.join(effects)}", place_of(bench.machine)[1]
        machine = f"{machine}:{axis}" if axis else machine  # `add` writes all axes
    else:
        words = ["compare", *(held or fit), "--fit", *fit, *bench.options(bench.machine), *files]
        words += ["--report", f"{made}.html"]
        label = "refitted"
    line, bags = _compare(bench, machine, number)
    first, before = _before(bench, number)
    lines = (*first, Line(tuple(words), _EFFECT_LINE), line)
    return Plan("Refitting", label, lines, bags, f"compared_{number}", machine=machine, made=made, before=before)


def diagnose_plan(bench: Bench, machine: str, number: int) -> Plan:
    """Search for what is missing, write `machine`, and compare it; UsageError without recordings in both roles."""
    fit, held, made = bench.paths("fit"), bench.paths("hold"), f"made_{number}"
    if not fit or not held:
        lacking = "fit" if not fit else "hold out"
        raise UsageError(f"a diagnosis needs recordings to fit and others to judge by; mark one '{lacking}'")
    words = ["diagnose", *fit, "--holdout", *held, *bench.options(bench.machine), "--out", machine]
    words += ["--json", f"{made}.json", "--report", f"{made}.html"]
    line, bags = _compare(bench, machine, number)
    first, before = _before(bench, number)
    lines = (*first, Line(tuple(words), _DIAGNOSE_LINE), line)
    return Plan("Diagnosing", "diagnosed", lines, bags, f"compared_{number}", machine, made=made, before=before)


def guess_plan(table: str, number: int) -> Plan:
    """Guess what the columns of `table` are, as the first map of it."""
    stem = f"guess_{number}"
    words = ["import", table, "--guess", "--map", f"{stem}.yaml", "--json", f"{stem}.json"]
    return Plan("Looking at the columns", "", (Line(tuple(words)),), (), "", guess=table, made=stem)


def import_plan(table: str, map_file: str, bag: str) -> Plan:
    """Make the recording `bag` of `table` by its map."""
    return Plan(
        IMPORTING, "", (Line(("import", table, "--map", map_file, "--out", bag)),), (), "", recordings=bag, map=map_file
    )


def campaign_plan(bench: Bench, namespace: str, folder: str, closed: str = "") -> Plan:
    """Drive a live plant with constant voltages, and record each run into `folder`; `closed`: as --closed."""
    effects = [word for path in bench.effects for word in ("--effects", path)]
    place = ["--namespace", namespace] if namespace else []
    words = ["experiment", "constant-voltage", *place, "--out", folder, "--model", bench.machine, *effects]
    words += [*live_options(bench.how, bench.rig), *(["--closed", closed] if closed else [])]
    return Plan("Constant voltages", "", (Line(tuple(words)),), (), "", recordings=folder)


def _before(bench: Bench, number: int) -> tuple[tuple[Line, ...], str]:
    """The comparison of the machine before, and the stem of its files; none if it was compared."""
    if bench.compared:
        return (), ""
    stem = f"before_{number}"
    return (_compare(bench, bench.machine, number, stem)[0],), stem


def _compare(bench: Bench, machine: str, number: int, stem: str = "") -> tuple[Line, tuple[str, ...]]:
    used, stem = bench.used(), stem or f"compared_{number}"
    if not used:
        raise UsageError("there is no recording to compare with; drop one on the page")
    words = ["compare", *(bag.path for bag in used), *bench.options(machine)]
    words += ["--json", f"{stem}.json", "--series", f"{stem}.npz", "--report", f"{stem}.html"]
    return Line(tuple(words), _COMPARE_LINE), tuple(bag.name for bag in used)
