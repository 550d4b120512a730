"""A rig's recording for the tests, message by message, so that each can be lost, shifted or damaged."""

from pathlib import Path

import numpy as np

from pneumo_ros.records import BagTopic, BagWriter, encoding
from pneumo_ros.records.contract import COMMAND, JOINT_STATES, PRESSURE_A, PRESSURE_B, TYPES

START = 1_700_000_000_000_000_000
N = 400
TIME = np.arange(N) / 1000
STAMP = START + np.arange(N) * 1_000_000
RNG = np.random.default_rng(7)
SIGNALS = {
    name: RNG.normal(size=N)
    for name in ("position", "velocity", "effort", "pressure_a", "pressure_b", "supply_pressure")
}
VOLTAGE = np.repeat(RNG.normal(size=N // 20), 20)
Streams = dict[str, tuple[np.ndarray, list[bytes]]]  # contract name -> recorded times [ns], messages


def streams(stamp: np.ndarray = STAMP, log: np.ndarray | None = None) -> Streams:
    """A rig that measures position and both pressures, every message recorded at its stamp or at `log`."""
    log = stamp if log is None else log
    position, variance = SIGNALS["position"], 9e4
    return {
        JOINT_STATES: (
            log,
            encoding.joint_states(stamp, "piston", {"position": position, "velocity": None, "effort": None}),
        ),
        PRESSURE_A: (log, encoding.pressures(stamp, SIGNALS["pressure_a"], variance)),
        PRESSURE_B: (log, encoding.pressures(stamp, SIGNALS["pressure_b"], variance)),
        COMMAND: (log, encoding.numbers(VOLTAGE)),
    }


def write(path: Path, content: Streams, namespace: str = "", types: dict[str, str] = TYPES) -> Path:
    """A bag of `content` under `namespace`."""
    messages = [
        (int(t), f"{namespace}/{name}", data)
        for name, (times, rows) in content.items()
        for t, data in zip(times, rows, strict=True)
    ]
    with BagWriter(path, [BagTopic(f"{namespace}/{name}", types[name]) for name in content]) as writer:
        for log_time, topic, data in sorted(messages, key=lambda message: message[0]):
            writer.write(topic, log_time, data)
    return path


def write_in_order(path: Path, content: Streams) -> Path:
    """A bag with the k-th messages of all topics written one after another, regardless of the recorder's clock."""
    with BagWriter(path, [BagTopic(f"/{name}", TYPES[name]) for name in content]) as writer:
        for index in range(N):
            for name, (times, rows) in content.items():
                if index < len(rows):
                    writer.write(f"/{name}", int(times[index]), rows[index])
    return path


def without(series: tuple[np.ndarray, list[bytes]], *missing: int) -> tuple[np.ndarray, list[bytes]]:
    """A stream that lost some of its messages."""
    kept = [index for index in range(len(series[0])) if index not in missing]
    return series[0][kept], [series[1][index] for index in kept]
