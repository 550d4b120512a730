"""What a simulation plays - a formula, voltages, the commands of a recording - and the signals that it records."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import UsageError
from pneumo_ros.plant.actuator import SIDES
from pneumo_ros.plant.closed import SECOND, mirrored
from pneumo_ros.plant.sensing import sense
from pneumo_ros.plant.signals import DRIVE
from pneumo_ros.runs.run import PARTS
from pneumo_ros.shooting.start import start_states

if TYPE_CHECKING:
    from collections.abc import Callable

    from pneumo_ros.command.inputs import Drive
    from pneumo_ros.plant import Model
    from pneumo_ros.reading.read import Reading

Array = NDArray[np.float64]

SECONDS = 10.0  # of an input without an end
RATE = 1000.0  # Hz
CHUNK = 50_000  # samples between two reports of progress


@dataclass(frozen=True)
class Plan:
    """The simulation to run.

    held: (samples * parts, inputs) voltage [V], or force [N], and what else the model reads; `parts` rows one after
    another in each sample.
    state: where it starts; text: what it is, for a person; commands: the arrays that the recording is to hold.
    """

    held: Array
    parts: int
    sample_time: float
    state: Array
    text: str
    commands: dict[str, Any]

    @property
    def samples(self) -> int:
        """How many samples are simulated."""
        return len(self.held) // self.parts


def drive_plan(
    model: "Model",
    drive: "Drive",
    *,
    seconds: float | None = None,
    rate: float | None = None,
    position: float = 0.0,
    second: "Drive | None" = None,
) -> Plan:
    """The plan for a drive: `seconds` of it at `rate` [Hz], from `position` [m] at rest.

    `second`: of the valve of chamber b, where there is one; None: it moves against the other, both counted from their
    closed signals. UsageError for a model that reads more than that.
    """
    if second and SECOND not in model.inputs:
        raise UsageError(f"'{model.name}' has one valve command; leave out --input-b, or add effect second_valve")
    if further := ", ".join(name for name in model.inputs[1:] if name != SECOND):
        raise UsageError(
            f"effects of '{model.name}' read measured signals ({further}); give a recording that has them as the input"
        )
    dt = 1.0 / (rate or RATE)
    samples = max(1, round((seconds or drive.duration or SECONDS) / dt))
    time = np.arange(1 + samples, dtype=float) * dt
    volts = drive.voltage(time)
    commands: dict[str, Any] = {} if model.force_driven else {"voltage": volts}
    held, text = volts[:, None], drive.text
    if SECOND in model.inputs:
        other = second.voltage(time) if second else mirrored(model, volts)
        changed = np.flatnonzero(np.diff(other, prepend=np.nan) != 0.0)
        commands |= {"command_b_time": time[changed], "command_b": other[changed]}
        held = np.column_stack([volts, other])
        text += f", chamber b: {second.text if second else 'against it'}"
    return Plan(held[:-1], 1, dt, model.state(y=position), text, commands)


def replay_plan(
    model: "Model", reading: "Reading", *, seconds: float | None = None, position: float | None = None
) -> Plan:
    """The plan for a recording: its commands at their times, from its start state or from `position` [m].

    UsageError when it is shorter than `seconds`.
    """
    recording, run = reading.recording, reading.run
    samples = len(run) - 1 if seconds is None else round(seconds / run.sample_time)
    if not 1 <= samples < len(run):
        raise UsageError(f"{seconds:g} s are asked; {recording.name} lasts {recording.duration:g} s")
    state = start_states(model, run, np.zeros(1, dtype=np.int64))[0]
    if position is not None:
        state = model.state(**{**dict(zip(model.states, state, strict=True)), "y": position})
    commands: dict[str, Any] = {}
    if recording.command_time is not None and recording.command is not None:
        sent = recording.command_time <= samples * run.sample_time
        commands = {"command_time": recording.command_time[sent], "command": recording.command[sent]}
    if recording.command_b_time is not None and recording.command_b is not None:
        sent = recording.command_b_time <= samples * run.sample_time
        commands |= {"command_b_time": recording.command_b_time[sent], "command_b": recording.command_b[sent]}
    text = f"the commands of {recording.name}"
    return Plan(run.inputs(model.inputs)[: samples * PARTS], PARTS, run.sample_time, state, text, commands)


def played(model: "Model", plan: Plan, progress: "Callable[[float], object]" = lambda share: None) -> Array:
    """States (samples + 1, states) at the start and at the end of each sample; `progress` gets the share done."""
    rows = [plan.state[None, :]]
    for begin in range(0, plan.samples, CHUNK):
        held = plan.held[begin * plan.parts : (begin + CHUNK) * plan.parts]
        start = begin * plan.sample_time
        rows.append(model.simulate(held, rows[-1][-1], sample_time=plan.sample_time, start=start, parts=plan.parts))
        progress(min((begin + CHUNK) / plan.samples, 1.0))
    return np.concatenate(rows)


def recorded(model: "Model", plan: Plan, states: Array) -> dict[str, Any]:
    """The arrays that `write_recording` takes, position and pressures as the sensors of the model read them.

    Measured pressures that the model read are recorded again.
    """
    time = np.arange(len(states)) * plan.sample_time
    column = {name: states[:, index] for index, name in enumerate(model.states)}
    column |= _readings(model, plan, states)
    signals = {"time": time, "position": column["y"], "velocity": column["v"]}
    if model.force_driven:
        held = np.concatenate([plan.held[:: plan.parts], plan.held[-1:]])
        read = dict(zip(model.inputs, held.T, strict=True))
        pressures = {f"pressure_{side}": read[f"p_{side}"] for side in SIDES if f"p_{side}" in read}
        return {**signals, "effort": read[DRIVE], **pressures}
    return {**signals, "effort": model.effort(states), **{one.field: column[one.state] for one in model.chambers}}


def _readings(model: "Model", plan: Plan, states: Array) -> dict[str, Array]:
    """What the sensors read, by the state that each measures; the first reading is that of the first input."""
    if model.composition.true_sensors:
        return {}
    first = np.zeros(1, dtype=np.int64)
    whole = states[np.newaxis, 1:], states[np.newaxis, :1]
    later, begin = (
        sense(model, rows, None, plan.held, first, sample_time=plan.sample_time, parts=plan.parts)[0] for rows in whole
    )
    return dict(zip(model.composition.sensed, np.concatenate([begin, later]).T, strict=True))
