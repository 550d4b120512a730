"""Which measured inputs recordings hold, and whether a model may read them."""

from collections.abc import Sequence

from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model
from pneumo_ros.plant.mechanical import mechanical
from pneumo_ros.plant.signals import DRIVE
from pneumo_ros.runs.run import SENSORS, Run

IN_PLACE = ("measured_supply",)  # inputs that take the place of a constant


def measured_inputs(runs: Sequence[Run]) -> tuple[str, ...]:
    """Names of the inputs that every run holds, U first."""
    return DRIVE, *(name for name in SENSORS if all(name in run.further for run in runs))


def measuring(model: Model, runs: Sequence[Run]) -> Model:
    """The model with the recorded supply pressure in place of its constant, where every run has it.

    Its mechanics alone, where no run has a valve command; DataError where some have one.
    """
    alone = [run for run in runs if run.force_driven]
    if alone and not model.force_driven:
        if commanded := [run.name for run in runs if not run.force_driven]:
            raise DataError(
                f"{alone[0].name} has no valve command, {commanded[0]} has one; give recordings of one kind, or a "
                "machine file without the section 'chambers', to judge friction and load alone in all of them"
            )
        model = mechanical(model) or model
    return model.measuring([name for name in IN_PLACE if name in measured_inputs(runs)])


def check_inputs(model: Model, run: Run) -> None:
    """Raises DataError, with the sensors that would be needed, when `model` reads an input that `run` lacks."""
    absent = [name for name in model.inputs if name != DRIVE and name not in run.further]
    if not absent:
        return
    readers = [
        e.name for e in model.composition.effects if any(n in f.reads for f in e.functions.values() for n in absent)
    ]
    topics = " and ".join(SENSORS.get(name, name) for name in absent)
    raise DataError(
        f"{run.name} has no {topics}, which effect {' and '.join(readers)} of '{model.name}' reads as "
        f"{' and '.join(absent)}; record also {topics}, or leave {' and '.join(readers)} out"
    )


def judged(model: Model, runs: Sequence[Run]) -> str:
    """Which equations these runs judge, which they do not, and the sensor that would add them: one line."""
    found, lacking = [], []
    if model.imposed and not model.force_driven:
        lacking.append("momentum (a load_cell would add it)")
    else:
        found.append("momentum")
    if model.force_driven:
        some = all(run.pressure_a is not None or "p_a" in run.further for run in runs)
        needed = "valve/command" if some else "valve/command and both chamber pressures"
        lacking.append(f"chambers and valve ({needed}, and a machine file with chambers, would add them)")
    else:
        found += ["chamber a", "chamber b"]
        if "measured_supply" not in measured_inputs(runs):
            lacking.append("a sagging supply by itself (supply/pressure would add it)")
    if "load_force" not in measured_inputs(runs) and not model.imposed:
        lacking.append("load apart from friction (a load_cell would add it)")
    said = f"Judged: {', '.join(found)}."
    return f"{said} Not judged: {'; '.join(lacking)}." if lacking else said
