"""Reading a recording into arrays: `read_topics` against deserialising message by message with rosbags.

    python benchmarks/bench_bag_reading.py [--messages 200000] [--repetitions 3]

Makes a recording of a 1 kHz axis (joint states with velocity and effort, both pressures, valve commands), reads it both
ways in turn, and prints medians and their ratio. The values are compared for every message and number.
"""

import argparse
import statistics
import tempfile
import time
from collections.abc import Callable
from functools import reduce
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.highlevel import AnyReader

from pneumo_ros.records import read_topics, write_recording

FIELDS = {
    "sensor_msgs/msg/JointState": ("header.stamp.sec", "header.stamp.nanosec", "position", "velocity", "effort"),
    "sensor_msgs/msg/FluidPressure": ("header.stamp.sec", "header.stamp.nanosec", "fluid_pressure", "variance"),
    "std_msgs/msg/Float64": ("data",),
}
Columns = dict[tuple[str, str], np.ndarray]


def make_recording(path: Path, messages: int) -> None:
    """A recording with `messages` messages, in equal parts on four topics."""
    count = messages // 4
    noise = np.random.default_rng(1).normal(size=(6, count))
    write_recording(
        path,
        time=np.arange(count) / 1000,
        position=noise[0],
        velocity=noise[1],
        effort=noise[2],
        pressure_a=4e5 + 300 * noise[3],
        pressure_b=4e5 + 300 * noise[4],
        voltage=noise[5],
        pressure_variance=9e4,
    )


def message_by_message(path: Path) -> Columns:
    """All numbers by rosbags' AnyReader."""
    lists: dict[tuple[str, str], list[Any]] = {}
    with AnyReader([path]) as reader:
        for connection, _, raw in reader.messages():
            message = reader.deserialize(raw, connection.msgtype)
            for field in FIELDS[connection.msgtype]:
                value = reduce(getattr, field.split("."), message)
                lists.setdefault((connection.topic, field), []).append(value)
    return {key: np.array(values) for key, values in lists.items()}


def in_bulk(path: Path) -> Columns:
    """All numbers by this package."""
    topics = read_topics(path)
    return {(name, field): data[field] for name, data in topics.items() for field in FIELDS[data.type]}


def timed(read: Callable[[Path], Columns], path: Path) -> tuple[float, Columns]:
    """Seconds and result of one reading."""
    start = time.perf_counter()
    columns = read(path)
    return time.perf_counter() - start, columns


def same(left: Columns, right: Columns) -> bool:
    """Whether both hold the same columns, value by value."""
    return left.keys() == right.keys() and all(np.array_equal(left[key], right[key]) for key in left)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--messages", type=int, default=200_000)
    parser.add_argument("--repetitions", type=int, default=3)
    options = parser.parse_args()
    seconds: dict[Callable[[Path], Columns], list[float]] = {message_by_message: [], in_bulk: []}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording"
        make_recording(path, options.messages)
        for _ in range(options.repetitions):
            columns = []
            for read, spent in seconds.items():
                took, found = timed(read, path)
                spent.append(took)
                columns.append(found)
            if not same(*columns):
                raise SystemExit("The two readings differ.")
        size = sum(file.stat().st_size for file in path.iterdir()) / 1e6
    slow, fast = (statistics.median(spent) for spent in seconds.values())
    count = options.messages // 4 * 4
    print(f"{count} messages on 4 topics, {size:.1f} MB, medians of {options.repetitions}")
    print(f"{'reader':<38}{'time [s]':>10}{'per message [us]':>18}{'ratio':>8}")
    for name, value in (("rosbags AnyReader, one by one", slow), ("pneumo_ros.records.read_topics", fast)):
        print(f"{name:<38}{value:>10.3f}{value / count * 1e6:>18.2f}{slow / value:>8.1f}")
    print("values identical")


if __name__ == "__main__":
    main()
