"""Recordings and tables as arrays, and arrays as recordings."""

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model
from pneumo_ros.reading.read import ATMOSPHERE, ReadOptions, corrected_recording
from pneumo_ros.reading.rig_file import read_rig, reading_of
from pneumo_ros.records import Recording, write_recording
from pneumo_ros.records.corrections import parse_words
from pneumo_ros.records.folders import recordings_in


def read(
    path: str | Path,
    *,
    namespace: str | None = None,
    joint: str | None = None,
    read_as: str = "",
    atmosphere: float = ATMOSPHERE,
    rig: str | Path | None = None,
) -> Recording:
    """The recording at `path` - a rosbag2 folder, an .mcap or .db3 file - as arrays in SI units.

    `namespace` of the axis and `joint`, where a recording holds several. `read_as`: words, separated by commas, for
    recordings in other units or wired otherwise, such as "bar,gauge" (see `pneumo compare --help`); `atmosphere` [Pa]
    is added to gauge pressures. `rig`: a rig file that says all that instead, as `pneumo rig check` writes it, with a
    machine file. Raises DataError when one of them cannot be read, UsageError for unknown words, for a rig file beside
    other words, and for a folder of recordings.
    """
    if inside := recordings_in(Path(path)):
        raise UsageError(
            f"{path} holds {len(inside)} recordings; read one, such as {inside[0]}, or give the folder to pn.compare, "
            "pn.diagnose, pn.identify or pn.add"
        )
    if rig is not None:
        if read_as or namespace or joint:
            raise UsageError(f"the rig file {rig} says how to read; leave read_as, namespace and joint out")
        said = read_rig(str(rig))
        machine = load_model(said.machine or "axis")
        air = machine.parameters.get("air.atmospheric_pressure", atmosphere)
        return corrected_recording(path, reading_of(said, machine), air)
    return corrected_recording(path, ReadOptions(namespace, joint, parse_words(read_as)), atmosphere)


def import_table(
    table: str | Path,
    map: str | Path | Mapping[str, Any] | None = None,
    *,
    out: str | Path | None = None,
    rate: float | None = None,
) -> Recording:
    """The recording that a published table (CSV, MAT, Parquet, NPZ, JSON, each also .gz) makes.

    `map`: what the columns are, as a file or as its content; None guesses it from headings, units and ranges. `out`:
    where to write the recording, None writes nothing. `rate` [Hz], 20 to 20000; None takes that of the rows. The map
    is in `description`. Raises UsageError for a map that does not fit, and where a guess lacks what a recording needs;
    DataError for a table that cannot be read or used.
    """
    from pneumo_ros.tables.even import check_rate
    from pneumo_ros.tables.importing import imported, write_bag
    from pneumo_ros.tables.map_file import load_map, parse_map
    from pneumo_ros.tables.reading import read_table

    check_rate(rate)
    source = read_table(table)
    if map is None:
        plan = parse_map(_guessed(source))
    else:
        plan = parse_map(map) if isinstance(map, Mapping) else load_map(map)
    found = imported(source, plan, rate)
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(scratch) / Path(table).name.split(".")[0] if out is None else Path(out)
        write_bag(found, path)
        made = corrected_recording(path, ReadOptions())
    return replace(made, path=Path(table) if out is None else path, warnings=(*made.warnings, *found.notes))


def _guessed(table: Any) -> Any:
    """The content of a guessed map; UsageError where it is not complete."""
    from pneumo_ros.tables.guess import guess
    from pneumo_ros.tables.guess_text import map_text
    from pneumo_ros.yaml_text import load_yaml

    found = guess(table)
    text = map_text(found, table.path.name)
    if not found.complete:
        raise UsageError(
            f"the columns of {table.path} are not all told by their names; complete this map and give it as `map`:\n"
            f"{text}"
        )
    return load_yaml(text)


def save(recording: Recording, path: str | Path) -> None:
    """Write a recording as a new rosbag2 folder, which appears whole or not at all; folders above it are made.

    Raises DataError when `path` exists.
    """
    names = ("position", "velocity", "effort", "pressure_a", "pressure_b", "supply_pressure", "load_cell", "further")
    signals: dict[str, Any] = {name: getattr(recording, name) for name in names}
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    commands: dict[str, Any] = {"command_time": recording.command_time, "command": recording.command}
    commands |= {"command_b_time": recording.command_b_time, "command_b": recording.command_b}
    write_recording(
        path, time=recording.time, description=recording.description, start_ns=recording.start_ns,
        joint_name=recording.joint_name, namespace=recording.namespace, **signals, **commands,
    )  # fmt: skip
