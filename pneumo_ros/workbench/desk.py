"""A desk: the state of one tab of the browser. It survives a reload of the page, and belongs to no other tab."""

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pneumo_ros.errors import PneumoError, UsageError
from pneumo_ros.files import write_whole
from pneumo_ros.plant import Model, save_model
from pneumo_ros.plant.axes_section import from_anywhere
from pneumo_ros.reading.read import ATMOSPHERE, ReadOptions
from pneumo_ros.units import LINE
from pneumo_ros.workbench.job import Job
from pneumo_ros.workbench.live import Live
from pneumo_ros.workbench.mapping import Mapped, edited, free_name, map_text, mapped
from pneumo_ros.workbench.plans import (
    IMPORTING,
    Bench,
    Plan,
    campaign_plan,
    compare_plan,
    diagnose_plan,
    guess_plan,
    import_plan,
    refit_plan,
)
from pneumo_ros.workbench.shelf import Shelf
from pneumo_ros.workbench.variant import Compared, Variant, model_of


@dataclass(frozen=True)
class Given:
    """Arguments of the command line: recordings, how to read them, the machine file, files of effects."""

    bags: tuple[str, ...] = ()
    how: ReadOptions = field(default_factory=ReadOptions)
    machine: str = "axis"
    effects: tuple[str, ...] = ()
    rig: str = ""  # the rig file, if one was given


class Desk:
    """Recordings, variants of the machine, effects ticked, and the running job, in a folder of its own."""

    def __init__(self, folder: Path, given: Given) -> None:
        self.folder, self.given = folder, given
        self.lock = threading.RLock()
        self.variants = [Variant(0, from_anywhere(given.machine), "as given")]
        self._coordinates = dict[str, str]()  # by machine file
        self.current, self.revision, self.message = 0, 0, ""
        self.chosen = 0  # counts the changes to another variant
        self.ticked: frozenset[str] = frozenset(self.model().effects)
        self.job: Job | None = None
        self.live: Live | None = None
        self._jobs = 0
        atmosphere = self.model().parameters.get("air.atmospheric_pressure", ATMOSPHERE)
        self.shelf = Shelf(folder, given.how, atmosphere, self.changed)
        self.mapping: Mapped | None = None  # the table that is being imported
        self.maps: tuple[str, ...] = ()  # their files
        self.imported: tuple[str, ...] = ()  # command lines that made recordings of tables
        self.opened: tuple[int, str] = (0, "")  # number of the last job that showed its result, and the tab
        self.shelf.take(given.bags)

    # --- machines ---------------------------------------------------------------------------------------------------

    @property
    def variant(self) -> Variant:
        """The current machine."""
        return self.variants[self.current]

    def model(self, number: int | None = None) -> Model:
        """The model of a variant, by default of the current one."""
        chosen = self.variant if number is None else self.variants[number]
        return model_of(chosen.machine, self.folder, self.given.effects)

    @property
    def coordinate(self) -> str:
        """Of the current machine; that of a line where its file cannot be read, which the panels say."""
        machine = self.variant.machine
        try:
            if machine not in self._coordinates:
                self._coordinates[machine] = self.model().coordinate
        except PneumoError:
            return LINE
        return self._coordinates[machine]

    def lineage(self, number: int | None = None) -> list[Variant]:
        """The variants from the machine as given to a variant."""
        chosen: Variant | None = self.variant if number is None else self.variants[number]
        found: list[Variant] = []
        while chosen is not None:
            found.insert(0, chosen)
            chosen = None if chosen.parent is None else self.variants[chosen.parent]
        return found

    def choose(self, number: int) -> None:
        """Make a variant the current machine."""
        with self.lock:
            self.current, self.chosen = number, self.chosen + 1
            self.ticked = frozenset(self.model().effects)
            self.changed()

    def undo(self) -> None:
        """Back to the parent of the current machine."""
        if self.variant.parent is not None:
            self.choose(self.variant.parent)

    def by_hand(self, values: Mapping[str, float]) -> None:
        """A variant with other values; UsageError for a value out of range."""
        said = ", ".join(f"{name} = {value:.6g}" for name, value in values.items())
        self._edited(self.model().with_parameters(values), "by hand", f"# set by hand: {said}")

    def _edited(self, model: Model, label: str, comment: str) -> None:
        with self.lock:
            number, before = len(self.variants), self.variant
            name = self._machine_name(number)
            save_model(model, self.folder / name, overwrite=True)
            line = f"{comment}; from {before.machine}, saved as {name}"
            self.variants.append(Variant(number, name, label, before.number, (line,)))
            self.choose(number)

    def _machine_name(self, number: int) -> str:
        return f"{Path(self.lineage()[0].machine).stem}_{number}.yaml"

    def take_machine(self, machine: str, label: str) -> None:
        """Begin again with another machine file, shipped or relative to the folder; raises what `load_model` raises."""
        model_of(machine, self.folder, self.given.effects)
        with self.lock:
            number = len(self.variants)
            self.variants.append(Variant(number, machine, label))
            self.choose(number)

    # --- tables -----------------------------------------------------------------------------------------------------

    def guess(self, table: str) -> None:
        """Start guessing what the columns of a table are; the page then shows a form."""
        self._start(lambda number: guess_plan(table, number))

    def import_table(self, timing: Mapping[str, Any], rows: Mapping[str, Mapping[str, Any]], motion: str) -> None:
        """Start importing the table with the map that was edited; UsageError for a map that lacks something."""
        assert self.mapping is not None
        table, content = self.mapping.table, edited(self.mapping, timing, rows, motion)
        with self.lock:
            number = self._jobs + 1
            name = free_name(Path(table).name.partition(".")[0], self.folder)
            write_whole(self.folder / f"map_{number}.yaml", map_text(content))
            self._start(lambda _: import_plan(table, f"map_{number}.yaml", name))

    # --- work -------------------------------------------------------------------------------------------------------

    def compare(self) -> None:
        """Start comparing the current machine; UsageError when there is nothing to compare with."""
        self._start(lambda number: compare_plan(self._bench(), number))

    def refit(self) -> None:
        """Start refitting with the effects that are ticked; UsageError when there is nothing to fit."""
        model = self.model()
        kept = [name for name in model.effects if name in self.ticked]
        new = sorted(self.ticked - {*model.effects})
        if not self._bench().paths("fit"):
            raise UsageError("no recording is marked 'fit'; mark one, then press Refit again")
        if len(kept) < len(model.effects):
            gone, ticked = [name for name in model.effects if name not in kept], self.ticked
            self._edited(model.with_effects(kept), f"- {', '.join(gone)}", f"# effects without {', '.join(gone)}")
            self.ticked = ticked
        self._start(lambda number: refit_plan(self._bench(), new, self._machine_name(len(self.variants)), number))

    def diagnose(self) -> None:
        """Start looking for what is missing; UsageError without recordings to fit and to judge by."""
        self._start(lambda number: diagnose_plan(self._bench(), self._machine_name(len(self.variants)), number))

    def cancel(self) -> None:
        """End the running job."""
        if self.job is not None:
            self.job.cancel()

    def campaign(self, namespace: str, closed: str = "") -> None:
        """Start driving a live plant with constant voltages; the recordings are added to the desk.

        `closed`: the signal that closes its valve, such as 5V; empty where the machine or rig file says it.
        """
        self._start(lambda number: campaign_plan(self._bench(), namespace, f"campaign_{number}", closed))

    def close(self) -> None:
        """End the running processes and wait for them."""
        self.cancel()
        if self.live is not None:
            self.live.close()
        if self.job is not None:
            self.job.wait(10.0)

    def _bench(self) -> Bench:
        effects = tuple(str(Path(path).resolve()) for path in self.given.effects)
        compared, rig = self.variant.compared is not None, self.given.rig
        return Bench(self.shelf.bags, self.shelf.how, self.variant.machine, effects, compared, rig)

    def _start(self, make: Callable[[int], Plan]) -> None:
        with self.lock:
            if self.job is not None and self.job.running:
                raise UsageError(f"{self.job.title} is running; cancel it first")
            self._jobs += 1
            plan, before = make(self._jobs), self.variant
            self.job = Job(plan.title, plan.lines, self.folder, lambda: self._done(plan, before), self.changed)
            self.changed()

    def _done(self, plan: Plan, before: Variant) -> None:
        """Keep the files that the verbs of a plan wrote."""
        if plan.guess:
            self.mapping = mapped(self.folder, plan.guess, plan.made + ".yaml", plan.made + ".json")
            self.opened = (self._jobs, "import")
            self.changed()
            return
        if plan.recordings:
            if plan.title == IMPORTING:
                self.imported, self.maps = (*self.imported, *plan.shown()), (*self.maps, plan.map)
            self.shelf.take([self.folder / plan.recordings])
            self.opened = (self._jobs, "signals")
            self.changed()
            return
        compared = self._compared(plan, plan.compared)
        with self.lock:
            if plan.before:
                made_from = self._compared(plan, plan.before)
                self.variants[before.number] = replace(self.variants[before.number], compared=made_from)
            if not plan.machine:
                self.variants[before.number] = replace(self.variants[before.number], compared=compared)
                self.opened = (self._jobs, "failures")
            else:
                made, number = self.folder / plan.made, len(self.variants)
                files = made.with_suffix(".json"), made.with_suffix(".html")
                self.variants.append(
                    Variant(number, plan.machine, plan.label, before.number, plan.shown(), *files, compared)
                )
                self.opened = (self._jobs, "diagnosis" if plan.title == "Diagnosing" else "error")
                self.choose(number)
            self.changed()

    def _compared(self, plan: Plan, name: str) -> Compared:
        stem = self.folder / name
        numbers, series, report = (stem.with_suffix(kind) for kind in (".json", ".npz", ".html"))
        return Compared(plan.bags, numbers, series, report, plan.line_of(name))

    def say(self, problem: PneumoError | str) -> None:
        """A sentence for the page; the next change removes it."""
        with self.lock:
            self.changed()
            self.message = str(problem)

    def changed(self) -> None:
        """The page has something new to show; takes no lock: jobs call it at their end."""
        self.revision, self.message = self.revision + 1, ""


def commands(lineage: Sequence[Variant]) -> str:
    """The command lines that make the last variant from the first, one below the other."""
    return "\n".join(line for variant in lineage for line in variant.lines)
