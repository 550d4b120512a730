"""One table in every format that is read, and maps of it."""

import gzip
import io
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy.io

from pneumo_ros.records.recording import Array

Columns = dict[str, Array]
RATE = 500.0  # Hz
NAMES = {
    "time": "t (ms)",
    "position": "x (mm)",
    "velocity": "v (m/s)",
    "pressure_a": "p1 (bar)",
    "pressure_b": "p2 (bar)",
}
MAP = """\
time: {column: t, unit: ms}
signals:
  position: {column: x, unit: mm}
  velocity: {column: v, unit: m/s}
  pressure_a: {column: p1, unit: bar, gauge: true}
  pressure_b: {column: p2, unit: bar, gauge: true}
  command: {column: u, unit: V}
"""


def columns(count: int = 400) -> Columns:
    """A servo axis: ms, mm, m/s, bar above the atmosphere's, V."""
    t = np.arange(count) / RATE
    return {
        "t (ms)": 1e3 * t,
        "x (mm)": np.round(40.0 * np.sin(5.0 * t), 6),
        "v (m/s)": np.round(0.2 * np.cos(5.0 * t), 9),
        "p1 (bar)": np.round(3.0 + np.cos(3.0 * t), 7),
        "p2 (bar)": np.round(2.5 - np.cos(3.0 * t), 7),
        "u (V)": np.where(t < 0.3, 0.0, 1.5),
    }


def text(table: Columns, delimiter: str = ",", decimal: str = ".", comment: str = "", units: bool = True) -> bytes:
    """The table as text, with a line of names."""
    names = [name if units else name.split(" ")[0] for name in table]
    rows = [
        delimiter.join(repr(float(value)).replace(".", decimal) for value in row)
        for row in zip(*table.values(), strict=True)
    ]
    return "\n".join([comment + delimiter.join(names), *rows, ""]).encode()


def packed_npz(table: Columns) -> bytes:
    """The table as NPZ."""
    stream = io.BytesIO()
    np.savez(stream, **table)
    return stream.getvalue()


def packed_npy(table: Columns) -> bytes:
    """The table as an array of records."""
    records = np.zeros(len(table["t (ms)"]), dtype=[(name, "f8") for name in table])
    for name, values in table.items():
        records[name] = values
    stream = io.BytesIO()
    np.save(stream, records)
    return stream.getvalue()


def matlab(table: Columns) -> bytes:
    """The table as a structure in a MAT-file, whose names have no units, beside a constant."""
    stream = io.BytesIO()
    scipy.io.savemat(stream, {"data": {name.split(" ")[0]: values for name, values in table.items()}, "gain": 1.5})
    return stream.getvalue()


def parquet(table: Columns) -> bytes:
    """The table as Parquet."""
    import pyarrow
    from pyarrow import parquet

    stream = io.BytesIO()
    parquet.write_table(pyarrow.table(table), stream)
    return stream.getvalue()


def records(table: Columns) -> list[dict[str, float]]:
    """The rows as records."""
    return [dict(zip(table, map(float, row), strict=True)) for row in zip(*table.values(), strict=True)]


# file -> bytes of the table
FORMATS: dict[str, Callable[[Columns], bytes]] = {
    "run.csv": text,
    "semicolons.csv": lambda table: text(table, ";", ","),
    "tabs.tsv": lambda table: text(table, "\t"),
    "german.tsv": lambda table: text(table, "\t", ","),
    "spaces.txt": lambda table: text(table, "|").replace(b" ", b"").replace(b"|", b"  "),
    "comment.exp": lambda table: text(table, ",", comment="#"),
    "excel.csv": lambda table: text(table, ";").decode().encode("utf-16"),
    "run.npz": packed_npz,
    "run.npy": packed_npy,
    "run.mat": matlab,
    "run.parquet": parquet,
    "records.json": lambda table: json.dumps({"mass": 0.5, "name": "x", "rows": records(table)}).encode(),
    "list.json": lambda table: json.dumps(records(table)).encode(),
    "columns.json": lambda table: json.dumps({name: values.tolist() for name, values in table.items()}).encode(),
    "run.jsonl": lambda table: "\n".join(map(json.dumps, records(table))).encode(),
    "lines.json": lambda table: "\n".join(map(json.dumps, records(table))).encode(),
}


def put(folder: Path, file: str, data: bytes | None = None, zipped: bool = False) -> Path:
    """The table (or `data`) in `folder / file`."""
    found = FORMATS[file](columns()) if data is None else data
    path = folder / (f"{file}.gz" if zipped else file)
    path.write_bytes(gzip.compress(found) if zipped else found)
    return path
