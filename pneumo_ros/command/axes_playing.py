"""A simulation of a machine of several axes: an input for each, one run of all, one recording."""

import argparse
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros import __version__
from pneumo_ros.command.console import Console
from pneumo_ros.command.inputs import FORMS, parse_drive
from pneumo_ros.command.noisy import with_noise
from pneumo_ros.command.playing import CHUNK, SECONDS, Plan, drive_plan, recorded, replay_plan
from pneumo_ros.command.recordings import read_one
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.multiaxis.drawing import MEASURED
from pneumo_ros.nearest import unknown_name
from pneumo_ros.plant.closed import closed_signal
from pneumo_ros.records.writing import write_axes

if TYPE_CHECKING:
    from collections.abc import Callable

    from pneumo_ros.command.inputs import Drive
    from pneumo_ros.multiaxis import Machine

Array = NDArray[np.float64]


def axes_plans(machine: "Machine", options: argparse.Namespace, console: Console) -> dict[str, Plan]:
    """What each axis plays, all of one length and rate; UsageError for inputs that name no axis."""
    path = Path(options.input[0])
    if path.is_dir() or path.suffix in (".mcap", ".db3"):
        return _replays(machine, options, console)
    if options.namespace or options.joint or options.read_as:
        raise UsageError(f"--namespace, --joint and --read-as go with a recording; --input is {options.input[0]}")
    drives, seconds_b = _by_axis(machine, options.input, "--input"), _by_axis(machine, options.input_b, "--input-b")
    lengths = [drive.duration for drive in drives.values() if drive.duration is not None]
    seconds = options.seconds or max(lengths, default=SECONDS)
    return {
        axis: drive_plan(
            model, drives.get(axis) or parse_drive(f"constant:{closed_signal(model)!r}"), seconds=seconds,
            rate=options.rate, position=options.position or 0.0, second=seconds_b.get(axis),
        )
        for axis, model in machine.axes.items()
    }  # fmt: skip


def _by_axis(machine: "Machine", given: "list[str] | None", option: str) -> "dict[str, Drive]":
    """The drive of each axis that `option` names, as shoulder=step:2.5@1."""
    found: dict[str, Drive] = {}
    for text in given or ():
        axis, equals, spec = text.partition("=")
        if not equals:
            example = next(iter(machine.axes))
            raise UsageError(
                f"'{machine.name}' has the axes {', '.join(machine.axes)}; {option} {text} names none of them. Type "
                f"{option} {example}={text} for one, once for each that moves; SPEC is {FORMS}"
            )
        if axis not in machine.axes:
            raise UsageError(f"{option} {text}: {unknown_name('axis', axis, machine.axes)}")
        if axis in found:
            raise UsageError(f"{option} is given twice for {axis}")
        found[axis] = parse_drive(spec)
    return found


def _replays(machine: "Machine", options: argparse.Namespace, console: Console) -> dict[str, Plan]:
    """The commands that a recording holds of every axis."""
    if len(options.input) > 1 or options.input_b or options.rate is not None:
        raise UsageError(
            "a replay takes all commands and its rate from one recording: leave out other inputs and --rate"
        )
    plans = {}
    for axis, model in machine.axes.items():
        one = argparse.Namespace(**{**vars(options), "namespace": namespace_of(options.namespace, axis)})
        reading = read_one(options.input[0], one, console, model)
        known = model.measuring([MEASURED] if MEASURED in reading.run.further else [])  # for its start state
        plan = replay_plan(known, reading, seconds=options.seconds, position=options.position)
        plans[axis] = replace(plan, held=plan.held[:, [name != MEASURED for name in known.inputs]])
    steps = [plan.sample_time for plan in plans.values()]
    if max(steps) > 1.001 * min(steps):
        raise DataError(f"{options.input[0]}: its axes were sampled at different rates; a replay needs one")
    shortest = min(plan.samples for plan in plans.values())
    return {
        axis: replace(plan, held=plan.held[: shortest * plan.parts], sample_time=steps[0])
        for axis, plan in plans.items()
    }


def namespace_of(above: str | None, axis: str) -> str:
    """The namespace of an axis below that of its machine; "shoulder" alone is found below any."""
    return f"{above.strip('/')}/{axis}" if above and above.strip("/") else axis


def played_together(machine: "Machine", plans: Mapping[str, Plan], progress: "Callable[[float], object]") -> Array:
    """States (samples + 1, states) of the machine at the start and at the end of each sample."""
    first = next(iter(plans.values()))
    held = np.column_stack([plan.held for plan in plans.values()])
    rows = [machine.state({axis: plan.state for axis, plan in plans.items()})[None, :]]
    for begin in range(0, first.samples, CHUNK):
        part = held[begin * first.parts : (begin + CHUNK) * first.parts]
        start = begin * first.sample_time
        rows.append(machine.simulate(part, rows[-1][-1], sample_time=first.sample_time, start=start, parts=first.parts))
        progress(min((begin + CHUNK) / first.samples, 1.0))
    return np.concatenate(rows)


def write_together(
    path: str,
    machine: "Machine",
    plans: Mapping[str, Plan],
    states: Array,
    noise: Mapping[str, float],
    random: np.random.Generator,
    seed: int | None,
) -> dict[str, dict[str, Any]]:
    """Write the recording of all axes, each with `noise` as `with_noise` has it; returns the signals of each."""
    head = {"schema_version": 1, "version": __version__, "seed": seed}
    signals = {
        axis: with_noise(
            recorded(machine.axes[axis], plans[axis], own), noise, random, force_driven=machine.axes[axis].force_driven
        )
        for axis, own in machine.split(states).items()
    }
    contents = {
        axis: {**one, **plans[axis].commands, "description": head | {"model": machine.axes[axis].as_dict()}}
        for axis, one in signals.items()
    }
    axis = next(name for name, one in machine.axes.items() if "air.supply_pressure" in one.parameters)
    supply = machine.supply_pressure(axis, states) if machine.supply is not None else None
    write_axes(path, contents, supply_pressure=supply, description=head | {"model": machine.as_dict()})
    return signals
