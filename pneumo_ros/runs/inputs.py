"""Which measured inputs recordings hold, and whether a model may read them."""

from collections.abc import Sequence

from pneumo_ros.errors import DataError
from pneumo_ros.plant import Model
from pneumo_ros.plant.library import is_part
from pneumo_ros.plant.mechanical import mechanical, pneumatic
from pneumo_ros.plant.reach import reads_drive
from pneumo_ros.plant.signals import DRIVE
from pneumo_ros.runs.run import METERED, SENSORS, Run

SUPPLY = "measured_supply"
IN_PLACE = {  # inputs that take the place of a constant: what they are, and the constant
    SUPPLY: ("supply pressure", "air.supply_pressure"),
    "loop_gain": ("gain of the position loop", "position_loop.proportional_gain"),
    "measured_voltage": ("voltage of the motor's source", "dc_motor.source_voltage"),
    "motor_on": ("power of the motor", "power throughout"),
}


def measured_inputs(runs: Sequence[Run]) -> tuple[str, ...]:
    """Names of the inputs that every run holds, U first."""
    return DRIVE, *(name for name in SENSORS if all(name in run.further for run in runs))


def predicts_force(runs: Sequence[Run]) -> bool:
    """Whether a test machine imposed the motion, and the drive of these runs is the force that it took."""
    return any(run.imposed and run.force_driven for run in runs)


def measuring(model: Model, runs: Sequence[Run]) -> Model:
    """The model with the recorded supply pressure in place of its constant, where every run has it.

    It predicts the flow into chamber a where every run has that of a flow meter. Its mechanics alone, where no run has
    a valve command; one chamber alone, where no run has the other's pressure. DataError where some have one.
    """
    alone = [run for run in runs if run.force_driven]
    if alone and not model.force_driven:
        if commanded := [run.name for run in runs if not run.force_driven]:
            raise DataError(
                f"{alone[0].name} has no valve command, {commanded[0]} has one; give recordings of one kind, or a "
                "machine file without the section 'chambers', to judge friction and load alone in all of them"
            )
        model = mechanical(model, by_force=not alone[0].by_pressures) or model
    if assumed := [run for run in runs if run.assumed]:
        if others := [run for run in runs if run.assumed != assumed[0].assumed]:
            chamber = next(iter(assumed[0].assumed)).split("_")[1]
            raise DataError(
                f"{assumed[0].name} has no chamber_{chamber}/pressure, {others[0].name} has it; give recordings of one "
                f"kind, or type --read-as no-pressure-{chamber} to judge the other chamber in all of them"
            )
        model = pneumatic(model)
    recorded = measured_inputs(runs)
    metered = [METERED] if METERED in recorded and model.has_valve and "a" in {c.side for c in model.chambers} else []
    return model.measuring([*metered, *(name for name in IN_PLACE if name in recorded)])


def in_place(model: Model, found: Model, runs: Sequence[Run]) -> str:
    """Which constants of `model` a measured signal replaces in `found`, and which no longer; one line."""
    said = []
    for name, (words, constant) in IN_PLACE.items():
        if name in {*model.inputs} ^ {*found.inputs}:
            taken = "measured, in place of"
            if any(name in run.computed for run in runs):
                taken = "computed from what all axes draw, in place of"
            taken = taken if name in found.inputs else "not measured in every run; it is"
            said.append(f"The {words} is {taken} {constant}")
    return "; ".join(said)


def check_inputs(model: Model, run: Run) -> None:
    """Raises DataError when `model` reads an input that `run` lacks, with the sensors that would be needed.

    And where an effect of it reads the drive, and that is the force of an imposed motion, which is predicted.
    """
    if model.force_driven and not model.self_driven and predicts_force([run]):
        for effect in model.composition.effects:
            if not is_part(effect) and reads_drive(effect):
                raise DataError(
                    f"{run.name}: the motion was imposed, and its force is what is predicted; effect {effect.name} of "
                    f"'{model.name}' reads that force as its drive, and would predict it from itself: leave "
                    f"{effect.name} out"
                )
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


def check_driven(model: Model, runs: Sequence[Run]) -> None:
    """Raises DataError where nothing that was measured drives the piston, so that friction cannot be identified."""
    if not model.imposed:
        return
    absent = sorted({name.split("_")[1] for run in runs for name in run.assumed})
    lacking = f"chamber_{absent[0]}/pressure" if absent else "measured force on the piston, whose motion is imposed"
    raise DataError(
        f"{runs[0].name} has no {lacking}: friction cannot be identified. To fit what the chambers show, type: pneumo "
        f"compare {runs[0].name} --fit {runs[0].name} --out MODEL"
    )


def judged(model: Model, runs: Sequence[Run]) -> str:
    """Which equations these runs judge, which they do not, and the sensor that would add them: one line."""
    assumed = sorted({name.split("_")[1] for run in runs for name in run.assumed})
    found, lacking = [], []
    if model.imposed and not model.force_driven:
        lacking.append(f"momentum ({_adding_momentum(model, assumed)} would add it)")
    else:
        found.append(f"momentum{', in its position loop' if model.self_driven else _open_side(runs)}")
    if model.force_driven and not model.self_driven:
        some = all(run.pressure_a is not None or run.pressure_b is not None or "p_a" in run.further for run in runs)
        needed = "valve/command" if some else "valve/command and both chamber pressures"
        lacking.append(f"chambers and valve ({needed}, and a machine file with chambers, would add them)")
    elif not model.force_driven:
        driven = ", driven by the position" if model.imposed else ""
        found += [f"chamber {one.side}{driven}" for one in model.chambers if one.side not in assumed]
        lacking += [f"chamber {one} (chamber_{one}/pressure would add it)" for one in assumed]
        if model.has_valve and _supply_unmeasured(runs):
            lacking.append("a sagging supply by itself (supply/pressure would add it)")
        found += ["flow into chamber a"] if METERED in model.composition.measured else []
    if "load_force" not in measured_inputs(runs) and not (model.imposed or predicts_force(runs)):
        lacking.append("load apart from friction (a load_cell would add it)")
    said = f"Judged: {', '.join(found)}."
    return f"{said} Not judged: {'; '.join(lacking)}." if lacking else said


def _supply_unmeasured(runs: Sequence[Run]) -> bool:
    return SUPPLY not in measured_inputs(runs) or any(SUPPLY in run.computed for run in runs)


def _adding_momentum(model: Model, assumed: Sequence[str]) -> str:
    """The sensor that would add the momentum equation where the motion is an input."""
    return f"chamber_{assumed[0]}/pressure" if assumed else "a load_cell"


def _open_side(runs: Sequence[Run]) -> str:
    """What is assumed of a chamber without a sensor where the pressures drive the piston or press on its seals."""
    if shared := [n for n in ("p_a", "p_b") if any(n in run.computed for run in runs)]:
        side = shared[0][-1]
        return f" (chamber {side} is taken at the other's pressure; chamber_{side}/pressure would show it)"
    absent = [n for n in ("p_a", "p_b") if any(run.by_pressures and n not in run.further for run in runs)]
    if not absent:
        return ""
    side = absent[0][-1]
    return f" (the other side is taken at the atmosphere's pressure; chamber_{side}/pressure would show it)"
