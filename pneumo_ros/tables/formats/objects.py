"""JSON: an object with a list of records or with columns, a list of records, or one record a line."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from pneumo_ros.errors import DataError
from pneumo_ros.tables.columns import table_of
from pneumo_ros.tables.formats.text import decoded
from pneumo_ros.tables.table import Table

_MOST_FIELDS = 1000  # of all records together


def read_json(path: Path, data: bytes) -> Table:
    """The table in one JSON object or list. Raises DataError where there is none."""
    try:
        content = json.loads(decoded(data))
    except (ValueError, RecursionError, DataError) as error:
        if isinstance(error, json.JSONDecodeError) and error.msg == "Extra data":  # one record a line
            return read_json_lines(path, data)
        raise DataError(f"cannot read {path} as JSON: {str(error)[:200]}") from error
    if isinstance(content, list):
        return table_of(path, _columns(path, content))
    if not isinstance(content, Mapping):
        raise DataError(f"{path} holds a single value; an object or a list of records is needed")
    lists = {name: value for name, value in content.items() if _is_records(value)}
    if not lists:
        return table_of(path, content)
    chosen = max(lists, key=lambda name: len(lists[name]))
    rest = {name: value for name, value in content.items() if name not in lists}
    others = [name for name in lists if name != chosen]
    notes = [f"'{chosen}' is read, the longest list of records; left out: {', '.join(others)}"] if others else []
    return table_of(path, {**_columns(path, lists[chosen]), **_singles(rest)}, notes)


def read_json_lines(path: Path, data: bytes) -> Table:
    """The table of one JSON object a line. Raises DataError, naming the line, for anything else."""
    try:
        lines = enumerate(decoded(data).split("\n"), start=1)
    except DataError as error:
        raise DataError(f"cannot read {path}: {error}") from error
    return table_of(path, _columns(path, [_record(path, number, line) for number, line in lines if line.strip()]))


def _record(path: Path, number: int, line: str) -> Mapping[str, Any]:
    """The object in one line."""
    try:
        record = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise DataError(f"cannot read {path}, line {number}: {str(error)[:200]}") from error
    if not isinstance(record, Mapping):
        raise DataError(f'cannot read {path}, line {number}: it is no JSON object, such as {{"t": 0.1, "p": 2.5}}')
    return record


def _is_records(value: Any) -> bool:
    return isinstance(value, list) and len(value) > 1 and all(isinstance(one, Mapping) for one in value)


def _columns(path: Path, records: list[Any]) -> dict[str, Any]:
    """The columns of records: a field that a record lacks is None there."""
    if not _is_records(records):
        return {"column": records}
    flat = [_flat(record) for record in records]
    names = dict.fromkeys(name for record in flat for name in record)
    if len(names) > _MOST_FIELDS:
        raise DataError(f"{path}: its records have {len(names)} different fields; at most {_MOST_FIELDS} are read")
    return {name: _cells([record.get(name) for record in flat]) for name in names}


def _cells(values: list[Any]) -> np.ndarray[Any, Any]:
    cells = np.empty(len(values), dtype=object)
    cells[:] = values
    return cells


def _flat(record: Mapping[str, Any]) -> dict[str, Any]:
    """A record with the fields of the objects and short lists in it, one level deep."""
    found: dict[str, Any] = {}
    for name, value in record.items():
        if isinstance(value, Mapping):
            found |= {f"{name}.{key}": inner for key, inner in value.items()}
        elif isinstance(value, list):
            found |= {f"{name}[{k}]": inner for k, inner in enumerate(value[:64])}
        else:
            found[name] = value
    return {name: value for name, value in found.items() if not isinstance(value, (Mapping, list))}


def _singles(rest: Mapping[str, Any]) -> dict[str, Any]:
    """What stands beside the records, without lists: they have no place in the table."""
    return {name: value for name, value in rest.items() if not isinstance(value, list)}
