"""Programmes as files: YAML to read, change and run again; CSV of voltages over time for other programs."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml

from pneumo_ros.errors import DataError, UsageError, brief
from pneumo_ros.experiment import voltages
from pneumo_ros.experiment.programme import Programme, Trial
from pneumo_ros.nearest import unknown_name
from pneumo_ros.yaml_text import load_yaml

_NUMBERS = {"low": "m", "high": "m", "end": "m", "return_right": "V", "return_left": "V", "rest": "s", "closed": "V"}
_TRIAL = ("name", "constant", "steps", "sweep", "ramps", "seconds", "patience", "travel", "anywhere")
_HEAD = """\
# Trials of '{experiment}', made for the machine '{machine}'. Run them with: pneumo experiment THIS_FILE
# Positions in m from mid stroke, voltages in V, times in s. A trial ends at low and high; the end stop is at +-end.
# return_right and return_left take the piston back; rest is how long it rests, recorded, before each trial.
# closed is the signal that closes the valve; all other voltages are counted from it. A rig does not move without it.
"""


def programme_text(programme: Programme) -> str:
    """The YAML file of a programme."""
    head = _HEAD.format(experiment=programme.experiment, machine=programme.machine)
    common: dict[str, Any] = {"experiment": programme.experiment, "machine": programme.machine}
    if programme.prepare:
        common["prepare"] = programme.prepare
    if programme.blind:
        common["blind"] = True
    said = [name for name in _NUMBERS if name != "closed" or programme.says_closed or programme.closed]
    numbers = {name: round(float(getattr(programme, name)), 6) for name in said}
    lines = ["trials:", *(f"  - {_flow(_trial_dict(trial))}" for trial in programme.trials)]
    return head + yaml.safe_dump({**common, **numbers}, sort_keys=False) + "\n".join(lines) + "\n"


def _trial_dict(trial: Trial) -> dict[str, Any]:
    entries: dict[str, Any] = {"name": trial.name, **voltages.as_dict(trial.voltage), "seconds": trial.seconds}
    if trial.direction:
        entries |= {"patience": trial.patience, "travel": round(trial.travel, 6)}
    if trial.anywhere:
        entries["anywhere"] = True
    return entries


def _flow(entries: dict[str, Any]) -> str:
    text: str = yaml.safe_dump(entries, sort_keys=False, default_flow_style=True, width=10_000)
    return text.strip()


def read_programme(path: str | Path) -> Programme:
    """The programme in a YAML file.

    Raises DataError when it cannot be read, UsageError with the place when it is invalid.
    """
    try:
        document = load_yaml(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, UsageError) as error:
        words = str(error) if isinstance(error, UsageError) else "it is no UTF-8 text"
        reason = error.strerror if isinstance(error, OSError) else words
        raise DataError(f"cannot read the programme {path}: {reason}") from error
    try:
        return _programme(document)
    except UsageError as error:
        raise UsageError(f"programme {path}: {error}") from error


def _programme(document: object) -> Programme:
    given = _section(document, "a programme", {"experiment", "machine", "prepare", "blind", "trials", *_NUMBERS})
    if not isinstance(given.get("trials"), list):
        raise UsageError("there is no list 'trials'")
    numbers: dict[str, Any] = {
        name: _number(given, name, unit)
        for name, unit in _NUMBERS.items()
        if name in given or name not in ("rest", "closed")
    }
    trials = tuple(_trial(entry) for entry in given["trials"])
    texts: dict[str, Any] = {name: str(given.get(name) or "") for name in ("experiment", "machine", "prepare")}
    blind = _flag(given, "blind", "the programme")
    return Programme(trials=trials, blind=blind, says_closed="closed" in given, **texts, **numbers)


def _trial(entry: object) -> Trial:
    given = _section(entry, "a trial", _TRIAL)
    name = str(given.get("name", ""))
    numbers = {key: _number(given, key, unit) for key, unit in {"patience": "s", "travel": "m"}.items() if key in given}
    anywhere = _flag(given, "anywhere", f"trial {brief(name)}")
    try:
        return Trial(name, voltages.from_dict(given), _number(given, "seconds", "s"), anywhere=anywhere, **numbers)
    except UsageError as error:
        raise UsageError(f"trial {brief(name)}: {error}") from error


def _section(value: object, what: str, allowed: Iterable[str]) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise UsageError(f"{what} takes entries, name: value, and is {brief(value)}")
    for name in value:
        if name not in allowed:
            raise UsageError(f"{unknown_name('entry', str(name), allowed)} ({what})")
    return value


def _flag(given: dict[str, Any], name: str, where: str) -> bool:
    value = given.get(name, False)
    if not isinstance(value, bool):
        raise UsageError(f"{where}: {name} is {brief(value)}; it takes true or false")
    return value


def _number(given: dict[str, Any], name: str, unit: str) -> float:
    value = given.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UsageError(f"{name} is {brief(value)}; it takes a number [{unit}]")
    try:
        return float(value)
    except OverflowError as error:  # an integer too large for a double
        raise UsageError(f"{name} is {brief(value)}; it takes a number [{unit}]") from error


def commands_text(programme: Programme, commands: Iterable[tuple[float, float]]) -> str:
    """CSV: time [s] and voltage [V], a row at each change; `commands` are those of a rehearsal."""
    rows = "".join(f"{time:.4f},{volts:.6g}\n" for time, volts in commands)
    return f"time,voltage\n# s,V: {programme.experiment} for {programme.machine}, as rehearsed with its model\n{rows}"
