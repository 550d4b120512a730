"""Checks for recordings that can be read but not used; they need no model."""

from collections.abc import Sequence

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.records.corrections import PRESSURE_UNITS
from pneumo_ros.records.recording import Array, Recording

_FEWEST, _SLOWEST = 50, 0.0505  # samples; s between them: valve and friction act within milliseconds
_VACUUM, _MOST = 1e4, 1e7  # Pa: lowest and highest pressure in a chamber of a pneumatic axis
FILLED = 5.5e6  # Pa: highest where a valve fills it, a tenth above the highest supply of a machine file
_OIL = 1e8  # Pa: highest pressure where the fluid is not modelled: that of a hydraulic cylinder
_USUAL = 5e4  # Pa: the pressures of a running axis reach it, gauge or absolute
_ABOVE_SUPPLY = 1.1  # times the supply pressure: most that a chamber reaches for long
_SEVERAL = 1e-3  # share of the samples below which impossible values are dropouts
# the highest value of a running axis, 0.9 to 13 bar, in each unit; the ranges of the units do not overlap much
_HIGHEST = (("MPa", 1.2), ("bar", 13.0), ("psi", 145.0), ("kPa", 1300.0), ("hPa", _VACUUM))


_BOTH = ("pressure_a", "pressure_b")


def check_use(
    recording: Recording,
    force_driven: bool,
    imposed: bool = False,
    pressures: Sequence[str] = _BOTH,
    commanded: bool = True,
) -> None:
    """Raises DataError for a recording that is too short, sampled too slowly, or lacks the input of the axis.

    A machine with chambers needs the pressure of each of them, or of one if the motion is `imposed`, in the range of
    absolute pressures in Pa: `pressures`, by their names in recordings. With a valve it is `commanded`, and needs its
    command unless the motion is `imposed`.
    """
    _check_time(recording)
    some = recording.pressure_a is not None or recording.pressure_b is not None
    unmeasured = [name for name in pressures if getattr(recording, name) is None]
    by_force = force_driven and recording.load_cell is not None
    if recording.imposed and not (imposed or by_force) and recording.effort is None and recording.voltage is None:
        raise DataError(
            f"{recording.name}: its motion is imposed, and it has neither a driving force nor a valve command. If its "
            "chambers are sealed, name imposed_motion among the effects of the machine file, and no valve; to judge "
            "its friction by a load cell, give --model a machine file without the section 'chambers'"
        )
    if imposed and (force_driven or len(unmeasured) == len(pressures)):
        raise DataError(
            f"{recording.name}: with imposed_motion, the pressures of the chambers are judged; the machine file needs "
            "the section 'chambers', and the recording chamber_a/pressure or chamber_b/pressure, better both"
        )
    if force_driven and recording.effort is None and not (recording.imposed and recording.load_cell is not None):
        raise DataError(
            f"{recording.name} has no effort and {'one' if some else 'no'} chamber pressure; a model without chambers "
            "is driven by a measured force or by the pressures on its piston"
            + ("; if a test machine imposed the motion, add --imposed" if recording.load_cell is not None else "")
        )
    if not (force_driven or imposed) and ((commanded and recording.voltage is None) or unmeasured):
        lacks = ["valve command"] if commanded and recording.voltage is None else []
        absent = " and ".join(f"no {name}" for name in (*lacks, *map(_topic, unmeasured)))
        needed = " and ".join([*(["a valve command"] if commanded else []), *map(_topic, pressures)])
        raise DataError(
            f"{recording.name} has {absent}; this machine file needs {needed} here. To judge friction and load alone, "
            "by a measured force or by the pressures on the piston, give --model a machine file without the section "
            "'chambers'."
        )
    if not force_driven:
        check_pressures(recording)


def check_pressures(recording: Recording, oil: bool = False) -> None:
    """Raises DataError for chamber pressures outside the range of absolute pressures in Pa, of gas or `oil`."""
    pressures = {"chamber_a/pressure": recording.pressure_a, "chamber_b/pressure": recording.pressure_b}
    given = {topic: pressure for topic, pressure in pressures.items() if pressure is not None}
    most = _OIL if oil else _MOST if recording.voltage is None else FILLED
    for topic, pressure in given.items():
        _check_size(recording, topic, pressure, list(given.values()), most)


def check_supply(recording: Recording) -> None:
    """Raises DataError for a supply pressure that is not absolute in Pa, or lower than what the chambers reach."""
    supply = recording.supply_pressure
    if supply is None:
        return
    others = [one for one in (recording.pressure_a, recording.pressure_b) if one is not None]
    _check_size(recording, "supply/pressure", supply, [supply, *others], FILLED)
    for topic, pressure in (("chamber_a", recording.pressure_a), ("chamber_b", recording.pressure_b)):
        if pressure is not None and np.quantile(pressure, 0.99) > _ABOVE_SUPPLY * supply.max():
            raise DataError(
                f"{recording.name}: supply/pressure is at most {supply.max():.4g} Pa, and {topic}/pressure reaches "
                f"{pressure.max():.4g} Pa: one of them is gauge pressure, or in another unit"
            )


def _topic(pressure: str) -> str:
    """The topic of a chamber's pressure, by its name in recordings."""
    return f"chamber_{pressure[-1]}/pressure"


def _check_time(recording: Recording) -> None:
    if len(recording.time) < _FEWEST:
        raise DataError(f"{recording.name} holds {len(recording.time)} samples; at least {_FEWEST} are needed")
    if recording.sample_time > _SLOWEST:
        raise DataError(
            f"{recording.name} is sampled every {1e3 * recording.sample_time:.3g} ms; valve and friction act within "
            f"milliseconds: record at {1.0 / _SLOWEST:.2g} Hz or more, better 1 kHz"
        )


def _check_size(recording: Recording, topic: str, pressure: Array, both: list[Array], most: float = _MOST) -> None:
    """Raises DataError unless `pressure` is in the range of absolute pressures in Pa; the advice depends on `both`."""
    lowest, highest = float(pressure.min()), float(pressure.max())
    if lowest >= _VACUUM and highest <= most:
        return
    at = recording.time[int(np.argmin(pressure) if lowest < _VACUUM else np.argmax(pressure))]
    span = f"{recording.name}: {topic} is {lowest:.4g} to {highest:.4g}"
    wanted = "absolute pressures in Pa are needed"
    if highest > most:
        kind = "a hydraulic one has" if most == _OIL else "a pneumatic axis has"
        of_oil = (
            "; of a cylinder that oil moves, friction and load alone are judged, driven by both pressures: type "
            "--read-as no-command"
        )
        raise DataError(
            f"{span} Pa, more than {kind}; {wanted}: check the unit, and --read-as if given"
            f"{of_oil if most == FILLED else ''}"
        )
    if highest < -_VACUUM:
        raise DataError(f"{span}: it counts the wrong way; change its sign where it is published")
    if lowest == highest or (np.mean(pressure < 0.0) > 0.2 and highest < _VACUUM):
        word = "no-supply" if topic.startswith("supply") else f"no-pressure-{topic[8]}"
        raise DataError(
            f"{span} in {len(pressure)} samples: its sensor gives no signal; look at its plug and supply, or type "
            f"--read-as {word} to judge the recording without it"
        )
    if highest < _USUAL:
        unit = _unit(both if all(one.max() < _VACUUM for one in both) else [pressure])
        raise DataError(f"{span}, as it would be in {_named(unit, both)}; {wanted}: {_advice(unit, both)}")
    if np.mean(pressure < _VACUUM) < _SEVERAL:
        many = int(np.count_nonzero(pressure < _VACUUM))
        raise DataError(
            f"{recording.name}: {topic} is {lowest:.4g} Pa at {at:.3f} s, lower than a chamber can be, in {many} of "
            f"{len(pressure)} samples: its sensor drops out; look at its plug, and cut these samples out"
        )
    raise DataError(
        f"{recording.name}: {topic} falls to {lowest:.4g} Pa at {at:.3f} s, where a vented chamber has the "
        f"atmosphere's 1e5 Pa: these are gauge pressures; {wanted}: type --read-as gauge, or add the atmosphere's "
        "where they are published"
    )


def _unit(pressures: list[Array]) -> str:
    """The unit in which the highest pressure is plausible for a running axis."""
    highest = max(float(one.max()) for one in pressures)
    return next((unit for unit, most in _HIGHEST if highest < most), "hPa")


def _named(unit: str, both: list[Array]) -> str:
    return f"{unit} gauge" if _gauge(unit, both) else unit


def _gauge(unit: str, both: list[Array]) -> bool:
    """Whether pressures in `unit` fall so low that they cannot be absolute."""
    return min(float(one.min()) for one in both) * PRESSURE_UNITS[unit] < _USUAL


def _advice(unit: str, both: list[Array]) -> str:
    publish = f"multiply {unit} by {PRESSURE_UNITS[unit]:.6g} where it is published"
    if any(one.max() >= _VACUUM for one in both):  # only one of them is in Pa: --read-as applies to both
        return publish
    gauge = _gauge(unit, both)
    more = ", and add the atmosphere's 1e5 Pa" if gauge else ""
    return f"type --read-as {unit}{',gauge' if gauge else ''}, or {publish}{more}"
