"""Simulations as recordings."""

import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from pneumo_ros import __version__
from pneumo_ros.api.inputs import Machine, Progress, machine
from pneumo_ros.command.inputs import Drive, parse_drive
from pneumo_ros.command.noisy import with_noise
from pneumo_ros.command.playing import RATE, Plan, drive_plan, played, recorded, replay_plan
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.reading.read import Reading, run_of
from pneumo_ros.records import Recording, contract
from pneumo_ros.units import LINE, writing


@writing(LINE)
def simulate(
    model: Machine = "axis",
    drive: str | ArrayLike | Recording = "step:2.5@1",
    *,
    seconds: float | None = None,
    rate: float | None = None,
    position: float | None = None,
    noise: Mapping[str, float] | None = None,
    seed: int = 0,
    name: str = "simulated",
    progress: Progress | None = None,
) -> Recording:
    """What the machine does: time [s], position [m], velocity [m/s], effort [N], pressures [Pa], voltage [V].

    `model`: a machine file, the name of a shipped one, or a Model. `drive`: "constant:V", "step:V@T", "sine:V,HZ", or a
    CSV file of times and volts; volts (n,), each held for a sample; or a recording, whose commands are replayed from
    its start. `seconds`: how long (None: the drive, else 10 s); `rate`: samples per second (None: 1000, or that of the
    recording); `position` [m]: where the piston starts. `noise`: standard deviations by signal, such as {"position":
    5e-6, "pressure_a": 200.0}, drawn from `seed`; velocity and effort, which a rig seldom measures, are then left out.
    `name` of the recording; `progress` is called with the share done and what is being done. Raises UsageError for a
    drive or a signal that is none of these, and NumericalError when the simulation diverges.
    """
    plant = machine(model)
    for what, value in (("seconds", seconds), ("rate", rate)):
        if value is not None and not (np.isfinite(value) and value > 0.0):
            raise UsageError(f"{what} is {value:g}; it takes a number above 0")
    plan = _plan(plant, drive, seconds, rate, position)
    tell = progress or (lambda share, text: None)
    states = played(plant, plan, lambda share: tell(share, "simulating"))
    random = np.random.default_rng(seed)
    signals = with_noise(recorded(plant, plan, states), noise or {}, random, force_driven=plant.force_driven)
    return _recording(plant, plan, signals, name)


def _plan(
    model: Model, drive: str | ArrayLike | Recording, seconds: float | None, rate: float | None, position: float | None
) -> Plan:
    if isinstance(drive, Recording):
        if rate is not None:
            raise UsageError("leave out rate: a replay keeps that of its recording")
        run, notes = run_of(drive, model)
        return replay_plan(model, Reading(drive, run, tuple(notes)), seconds=seconds, position=position)
    given = parse_drive(drive) if isinstance(drive, str) else _held(drive, rate or RATE)
    return drive_plan(model, given, seconds=seconds, rate=rate, position=position or 0.0)


def _held(volts: ArrayLike, rate: float) -> Drive:
    """Voltages (n,) at `rate` [Hz]; the last one stays."""
    values = np.asarray(volts, dtype=float)
    if values.ndim != 1 or not len(values) or not np.isfinite(values).all():
        raise UsageError(f"the drive has the shape {values.shape}; it takes finite volts (n,), one for each sample")

    def voltage(at: np.ndarray) -> np.ndarray:
        return np.asarray(values[np.clip(np.floor(at * rate + 1e-6).astype(int), 0, len(values) - 1)])

    return Drive(voltage, len(values) / rate, f"{len(values)} voltages")


def _recording(model: Model, plan: Plan, signals: dict[str, np.ndarray], name: str) -> Recording:
    times, volts = plan.commands.get("command_time"), plan.commands.get("command")
    voltage = plan.commands.get("voltage")
    if voltage is not None:
        changed = np.flatnonzero(np.diff(voltage, prepend=np.nan) != 0.0)
        times, volts = signals["time"][changed], voltage[changed]
    elif times is not None and volts is not None:
        last = np.searchsorted(times, signals["time"], side="right") - 1
        voltage = np.asarray(volts)[np.maximum(last, 0)]
    return Recording(
        name=name, path=Path(name), namespace="", joint_name=contract.JOINT, start_ns=time.time_ns(),
        time=signals["time"], position=signals["position"], velocity=signals.get("velocity"),
        effort=signals.get("effort"), pressure_a=signals.get("pressure_a"), pressure_b=signals.get("pressure_b"),
        supply_pressure=None, voltage=voltage, command_time=times, command=volts,
        description={"schema_version": 1, "version": __version__, "model": model.as_dict(), "seed": None},
        warnings=(), command_b_time=plan.commands.get("command_b_time"), command_b=plan.commands.get("command_b"),
    )  # fmt: skip
