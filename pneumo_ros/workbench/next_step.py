"""The next sensible step at a desk, and the steps that are done: decided from what the verbs wrote."""

from dataclasses import dataclass

from pneumo_ros.compare.findings import explained
from pneumo_ros.wording.naming import listed
from pneumo_ros.workbench.desk import Desk
from pneumo_ros.workbench.error_panel import judged_by
from pneumo_ros.workbench.variant import runs_of

SHIPPED = ("axis", "paper", "emps")  # machine files that are nobody's rig


@dataclass(frozen=True)
class NextStep:
    """The button to press, its name, and why; `why` is empty while a job runs."""

    key: str
    title: str
    why: str


def done(desk: Desk) -> set[str]:
    """The steps that the current machine has behind it."""
    made = [variant for variant in desk.lineage() if variant.result]
    found = {"import"} if any(not bag.problem for bag in desk.shelf.bags) else set()
    found |= {"rig"} if desk.lineage()[0].machine not in SHIPPED or desk.variant.number else set()
    found |= {"compare"} if desk.variant.compared else set()
    found |= {"diagnose"} if any("candidates" in variant.made_by() for variant in made) else set()
    return found | ({"refit"} if any("candidates" not in variant.made_by() for variant in made) else set())


def next_step(desk: Desk) -> NextStep:
    """The first of these that applies: wait, import, refit what is ticked, compare, hold out, save, diagnose."""
    if desk.job is not None and desk.job.running:
        return NextStep("", "", "")
    usable = [bag for bag in desk.shelf.bags if not bag.problem]
    if not usable:
        return _import(bool(desk.shelf.bags))
    edited = _edited(desk)
    if edited:
        return NextStep("refit", "Refit", f"It fits the machine {edited} to the recordings marked 'fit'.")
    if desk.variant.compared is None:
        return NextStep("compare", "Compare", f"It shows where {_name(desk)} fails.{_own(desk)}")
    if _explained(desk):
        why = "Noise explains what this machine leaves open in these recordings: keep its file and the report."
        return NextStep("save", "Save", why)
    return _search(desk, {bag.role for bag in usable})


def _import(broken: bool) -> NextStep:
    first = "None of these recordings can be read; the list says why. " if broken else ""
    return NextStep("import", "Import", f"{first}Drop recordings on the page, or choose a table.")


def _search(desk: Desk, roles: set[str]) -> NextStep:
    """The machine is compared and fails: look for what is missing, unless that was done."""
    if "diagnose" in done(desk):
        experiment = _diagnosed(desk).get("suggested_experiment")
        more = f" Record what the diagnosis asks for: {experiment}" if experiment else ""
        return NextStep("save", "Save", f"The diagnosis is done; keep its machine file and its report.{more}")
    if not {"fit", "hold"} <= roles:
        lacking = "hold out" if "fit" in roles else "fit"
        why = f"A diagnosis judges by recordings that it did not fit: first mark one '{lacking}' in the list."
        return NextStep("diagnose", "Diagnose", why)
    return NextStep("diagnose", "Diagnose", "The machine fails on these recordings: look for what it lacks.")


def _diagnosed(desk: Desk) -> dict[str, object]:
    return next((v.made_by() for v in reversed(desk.lineage()) if "candidates" in v.made_by()), {})


def _edited(desk: Desk) -> str:
    """What the ticks change, in words; empty when they are the effects of the machine."""
    own = desk.model().effects
    new, gone = sorted(desk.ticked - {*own}), [name for name in own if name not in desk.ticked]
    words = [f"{word} {listed([name.replace('_', ' ') for name in some])}"
             for word, some in (("with", new), ("without", gone)) if some]  # fmt: skip
    return " and ".join(words)


def _own(desk: Desk) -> str:
    """A hint for recordings of a machine that is not the shipped one."""
    return "" if "rig" in done(desk) else " If your rig is another one, choose its machine file under Rig first."


def _name(desk: Desk) -> str:
    given = desk.variant.parent is None and desk.variant.machine == "axis"
    return "the shipped example machine" if given else "the machine"


def _explained(desk: Desk) -> bool:
    """Whether noise explains every equation, and the typical prediction on the recordings that judge."""
    compared = desk.variant.compared
    assert compared is not None
    return explained(compared.result, runs_of(compared, judged_by(desk)[0]))
