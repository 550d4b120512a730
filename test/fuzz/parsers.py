"""The parsers: for each, the file it reads, the call, the conditions for any result, and the inputs."""

import io
import json
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

import numpy as np
import yaml
from hypothesis import strategies as st

from fuzz import asking, recordings, texts
from fuzz.mutation import mutated
from pneumo_ros.command.inputs import read_csv
from pneumo_ros.control.control_file import load_control
from pneumo_ros.experiment.programme_file import programme_text, read_programme
from pneumo_ros.multiaxis import load_machine
from pneumo_ros.multiaxis import machine_text as axes_text
from pneumo_ros.multiaxis.machine_file import machine_from_dict
from pneumo_ros.parts.listing import markdown
from pneumo_ros.parts.shelf import read_part
from pneumo_ros.plant import load_model
from pneumo_ros.plant.library import Library
from pneumo_ros.plant.machine_file import machine_text, parse_machine, sections_of
from pneumo_ros.records import Bag, read_recording, read_topics
from pneumo_ros.tables.guess import guess
from pneumo_ros.tables.guess_text import map_text
from pneumo_ros.tables.importing import imported
from pneumo_ros.tables.map_file import load_map, parse_map
from pneumo_ros.tables.reading import read_table
from pneumo_ros.yaml_text import load_yaml

Inputs = Callable[[], st.SearchStrategy[bytes]]


class Parser(NamedTuple):
    """`read` raises PneumoError or asserts the conditions for its result; `put` writes the file."""

    name: str
    file: str
    read: Callable[[Path], None]
    inputs: Inputs
    sound: Callable[[], bytes]  # a file that it reads
    beside: Callable[[], bytes] | None = None  # of a metadata.yaml: the recording that it describes

    def put(self, folder: Path, data: bytes) -> Path:
        """The file with `data` in it."""
        path = folder / self.file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        if self.beside is not None and not (other := path.with_name("bag.mcap")).exists():
            other.write_bytes(self.beside())
        return path


# --- recordings -------------------------------------------------------------------------------------------------------


def read_columns(path: Path) -> None:
    """Every column of every topic; as many values as messages."""
    for data in read_topics(path).values():
        for field in data.fields:
            assert len(data[field]) == len(data)


def read_everything(path: Path) -> None:
    """The columns; and the axis, even when the columns cannot be read."""
    try:
        read_columns(path)
    finally:
        read_axis(path)


def read_axis(path: Path) -> None:
    """The axis, and the promises of a recording about its arrays."""
    run = read_recording(path)
    assert run.time[0] == 0.0
    assert (np.diff(run.time) > 0.0).all()
    for values in (run.position, run.velocity, run.effort, run.pressure_a, run.pressure_b, run.voltage):
        assert values is None or (values.shape == run.time.shape and np.isfinite(values).all())
    assert run.description is None or isinstance(run.description, dict)


def read_in_order(path: Path) -> None:
    """Every message, as the player reads them."""
    bag = Bag(path)
    view = bag.overview()
    assert sum(view.counts.values()) == sum(1 for _ in bag.messages())


def read_folder(path: Path) -> None:
    """The folder of a metadata.yaml."""
    read_in_order(path.parent)


# --- files of a person ------------------------------------------------------------------------------------------------


def read_machine(path: Path) -> None:
    """A machine file that loads is written and read again as the same machine."""
    model = load_model(path)
    again = parse_machine(machine_text(model), model.name, Library())
    assert (again.effects, again.parameters) == (model.effects, model.parameters)


def read_axes(path: Path) -> None:
    """A machine file of several axes that loads is written and read again as the same machine."""
    machine = load_machine(path)
    again = machine_from_dict(sections_of(axes_text(machine)), machine.name, Library())
    assert again.as_dict() == machine.as_dict()


def read_part_file(path: Path) -> None:
    """A part file that loads has a source for every figure, and is shown."""
    part = read_part(path)
    assert all(figure.source and figure.low <= figure.value <= figure.high for figure in part.figures.values())
    assert part.name in markdown([part])


def read_control(path: Path) -> None:
    """A control file that loads makes a law."""
    control = load_control(path)
    axis = load_model("axis")
    control.make(axis.effects, axis.parameters)
    assert all(np.isfinite(value) for value in control.gains.values())


def read_trials(path: Path) -> None:
    """A programme that loads is written and read again."""
    programme = read_programme(path)
    assert all(np.isfinite(trial.voltage.at(at * trial.seconds)) for trial in programme.trials for at in (0.0, 0.7))
    path.write_text(programme_text(programme), encoding="utf-8")
    assert len(read_programme(path).trials) == len(programme.trials)


def read_voltages(path: Path) -> None:
    """A CSV file that is read gives a finite voltage at any time."""
    drive = read_csv(path)
    assert drive.duration is not None
    assert np.isfinite(drive.voltage(np.array([0.0, drive.duration]))).all()


def read_effects(path: Path) -> None:
    """A file of effects that loads makes a machine; it contains code by design, so only its form is changed."""
    model = load_model("axis", [path])
    own = sorted(set(Library([path]).names()) - set(Library().names()))
    model.with_effects([*model.effects, *own])


def read_published(path: Path) -> None:
    """A table that is read has columns of one length; a guessed map is read, and imports finite numbers or says why."""
    table = read_table(path)
    assert len({len(values) for values in table.columns.values()}) == 1
    found = guess(table)
    if found.complete:
        made = imported(table, parse_map(load_yaml(map_text(found, path.name))))
        assert (np.diff(made.time) > 0.0).all()
        assert all(np.isfinite(values).all() for values in made.signals.values())


def read_plan(path: Path) -> None:
    """A map that is read has only known signals, with a column each."""
    plan = load_map(path)
    assert all(entry.columns for entry in plan.signals.values())


EFFECT = '''\
from pneumo_ros.plant.effect import Effect, Parameter, State, sqrt


class SealLeak(Effect):
    """Turbulent leakage across the piston seal."""

    conductance = Parameter(1e-7, "kg/(s*sqrt(Pa))", "seal leak coefficient", low=0.0, neutral=0.0)

    def equations(p_a, p_b, conductance):
        leak = conductance * (p_a - p_b) / sqrt(abs(p_a - p_b) + 1.0)
        flow_a, flow_b = -leak, leak
        return flow_a, flow_b
'''
PROGRAMME = """\
experiment: steps
machine: axis
low: -0.8
high: 0.8
end: 0.95
return_right: 2.0
return_left: 2.0
rest: 0.6
trials:
  - {name: constant_p1100, constant: 1.1, seconds: 4.0, patience: 1.0, travel: 1.2}
  - {name: steps, steps: [[0.5, 1.0], [0.5, -1.0]], seconds: 1.0}
  - {name: sweep, sweep: {amplitude: 2.0, first: 0.2, last: 5.0, seconds: 10.0}, seconds: 10.0, anywhere: true}
"""
CSV = b"time,voltage\n0,0\n0.5,1.5\n1.0;-2\n# remark\n1.5,3e0\n"


TABLE = ("t (ms),x (mm),p1 (bar),p2,F\n" + "".join(
    f"{2 * k},{k % 7 + 0.25 * k},{3 + k % 5},{300000 + k * k},{k % 3 - 1.5}\n" for k in range(40)
)).encode()  # fmt: skip
PLAN = """\
time: {column: t, unit: ms}
motion: imposed
constants: {atmospheric_pressure: {value: 1013, unit: mbar}, kt: 0.3}
signals:
  position: {column: x, unit: mm, sign: -1, scale: 1.0e-3, offset: -20}
  force: {columns: [i, j], gains: [kt, -1.0], times: u, bits: 16, unit: N m}
  pressure_a: {column: p1, unit: bar, gauge: true}
others: {oil: {column: p2, unit: psi}}
"""


def _json_table() -> bytes:
    rows = [{"t": 0.002 * k, "x": k % 7 + 0.1 * k, "F": k % 3 - 1.5, "on": True} for k in range(40)]
    return json.dumps({"mass": 1.0, "rows": rows}).encode()


def _npz_table() -> bytes:
    stream = io.BytesIO()
    np.savez(stream, t=np.arange(40) * 0.002, x=np.sin(np.arange(40)), F=np.cos(np.arange(40)))
    return stream.getvalue()


PART = files("pneumo_ros.parts").joinpath("data/valves/smc-sy7000.yaml").read_bytes()
AXES = b"""/**:
  ros__parameters:
    axes: [lift, reach]
    effects: [viscous_friction]
    viscous_friction: {coefficient: 50.0}
    lift: {piston: {mass: 5.0, area_a: 4.1e-4, area_b: 3.0e-4, stroke: 2.0}}
    reach: {piston: {mass: 2.0, area_a: 4.1e-4, area_b: 3.0e-4, stroke: 1.0}}
"""
STATED = b"    uncertainty:\n      lugre_friction: {coulomb_friction: 12.0, static_friction: 40 %}\n"


def _shipped(name: str) -> bytes:
    return files("pneumo_ros.config").joinpath(f"{name}.yaml").read_bytes()


def _of_text(text: bytes) -> tuple[Inputs, Callable[[], bytes]]:
    """Inputs that are nearly the YAML `text`, and itself."""
    return lambda: mutated([text]) | texts.yaml_files(yaml.safe_load(text)), lambda: text


def _databases() -> st.SearchStrategy[bytes]:
    orders = st.sampled_from(recordings.SQL).map(recordings.sql_spoilt)
    return mutated([recordings.folder_seeds()[0]]) | orders


def _metadata() -> st.SearchStrategy[bytes]:
    return _of_text(recordings.folder_seeds()[1])[0]()


def _mcap() -> bytes:
    return recordings.mcap_seeds()[0]


PARSERS = (
    Parser("MCAP, damaged bytes", "bag.mcap", read_everything, lambda: mutated(recordings.mcap_seeds()), _mcap),
    Parser("MCAP, broken messages", "bag.mcap", read_everything, recordings.spoilt_messages, _mcap),
    Parser("MCAP, broken definitions", "bag.mcap", read_columns, recordings.spoilt_definitions, _mcap),
    Parser("JSON of a description", "bag.mcap", read_axis, recordings.described, _mcap),
    Parser("SQLite recording", "bag.db3", read_in_order, _databases, lambda: recordings.folder_seeds()[0]),
    Parser("metadata.yaml", "bag/metadata.yaml", read_folder, _metadata, lambda: recordings.folder_seeds()[1], _mcap),
    Parser("machine file", "machine.yaml", read_machine, *_of_text(_shipped("axis"))),
    Parser("machine file of several axes", "machine.yaml", read_axes, *_of_text(AXES)),
    Parser("part file", "part.yaml", read_part_file, *_of_text(PART)),
    Parser("machine file with uncertainty", "machine.yaml", read_machine, *_of_text(_shipped("axis") + STATED)),
    Parser("control file", "control.yaml", read_control, *_of_text(_shipped("control/cascade"))),
    Parser("programme", "programme.yaml", read_trials, *_of_text(PROGRAMME.encode())),
    Parser("CSV of voltages", "input.csv", read_voltages, lambda: mutated([CSV]) | texts.CSV_FILES, lambda: CSV),
    Parser("table as text", "run.csv", read_published, lambda: mutated([TABLE]) | texts.CSV_FILES, lambda: TABLE),
    Parser("table as JSON", "run.json", read_published, lambda: mutated([_json_table()]), _json_table),
    Parser("table as NPZ", "run.npz", read_published, lambda: mutated([_npz_table()]), _npz_table),
    Parser("map of a table", "map.yaml", read_plan, *_of_text(PLAN.encode())),
    Parser("HTTP of the workbench", "request", asking.ask, asking.inputs, lambda: asking.requests()[0]),
    Parser("file of effects", "mine.py", read_effects, lambda: mutated([EFFECT.encode()], 3), lambda: EFFECT.encode()),
)
