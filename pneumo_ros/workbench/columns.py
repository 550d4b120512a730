"""Every number that a recording holds, by topic and field, over the time of the run."""

from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.records import Recording, read_topics
from pneumo_ros.records.topic_data import TopicData

Array = NDArray[np.float64]
Column = tuple[Array, Array]
_KEPT = 4  # recordings whose columns stay in memory
_ELEMENTS = 6  # of an array that get a name each
_TIMES = ("header.stamp.sec", "header.stamp.nanosec")


def columns(path: Path, recording: Recording) -> dict[str, Column]:
    """Name such as '/load_cell effort[0]' -> time since the run's first sample [s] and values, both (m,).

    Raises DataError when the recording cannot be read.
    """
    newest = max((inner.stat().st_mtime_ns for inner in [path, *path.glob("*")]), default=0)
    return _columns(path, newest, recording.start_ns)


@lru_cache(_KEPT)
def _columns(path: Path, newest: int, start: int) -> dict[str, Column]:
    topics = read_topics(path)
    states = [data for name, data in topics.items() if name.endswith("joint_states") and len(data)]
    first = min((int(data.log_time[0]) for data in states or topics.values() if len(data)), default=0)
    return {name: column for data in topics.values() for name, column in _of(data, start, first).items()}


def _of(data: TopicData, start: int, first: int) -> dict[str, Column]:
    """The columns of one topic; without a stamp its messages are timed by when they were recorded."""
    stamped = _TIMES[0] in data.fields
    time: Array = np.asarray(1e-9 * (data.stamp - start if stamped else data.log_time - first), dtype=np.float64)
    found = dict[str, Column]()
    for field in data.fields:
        values = data[field]
        if field in _TIMES or values.dtype.kind not in "biuf" or values.ndim > 2:
            continue
        if values.ndim == 1:
            found[f"{data.name} {field}"] = (time, np.asarray(values, dtype=np.float64))
        else:
            for k in range(min(values.shape[1], _ELEMENTS)):
                found[f"{data.name} {field}[{k}]"] = (time, np.asarray(values[:, k], dtype=np.float64))
    return found
