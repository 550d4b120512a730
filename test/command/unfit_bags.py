"""Faulty recordings, each made from a good one of the independent rig, as real bags."""

import shutil
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rig import bags
from rig import case as rig_case
from rig.effects import build
from rig.sensors import Run

from pneumo_ros.records import Bag, BagTopic, BagWriter

EPOCH = 1_700_000_000 * 10**9
SECOND = 10**9
START, STOP = 2000, 7600  # samples between which a signal freezes or is lost
LENGTH = 8000


def good_run() -> Run:
    """Eight seconds of random steps on a worn machine."""
    run = rig_case.make_run(build(0), "train_steps")
    arrays = {name: value[:LENGTH] for name, value in run._asdict().items() if isinstance(value, np.ndarray)}
    return run._replace(**arrays | {"command_index": run.command_index[run.command_index < LENGTH]})


def changed(run: Run) -> dict[str, dict[str, np.ndarray]]:
    """Name -> the change to the good run."""
    a, b, y = run.pressure_a, run.pressure_b, run.position
    rng, k = np.random.default_rng(0), np.arange(LENGTH)
    hangs = (k >= START) & (k < STOP)
    resting = np.round((y[START] + rng.normal(0.0, 5e-6, LENGTH)) / 1e-5) * 1e-5
    noise = rng.normal(0.0, 300.0, LENGTH)
    return {
        "good": {},
        "swapped": {"pressure_a": b, "pressure_b": a},
        "bar": {"pressure_a": 1e-5 * a, "pressure_b": 1e-5 * b},
        "kpa": {"pressure_a": 1e-3 * a, "pressure_b": 1e-3 * b},
        "psi": {"pressure_a": a / 6894.757, "pressure_b": b / 6894.757},
        "bar_gauge": {"pressure_a": 1e-5 * a - 1.0, "pressure_b": 1e-5 * b - 1.0},
        "one_in_bar": {"pressure_b": 1e-5 * b},
        "gauge": {"pressure_a": a - 1e5, "pressure_b": b - 1e5},
        "drops_out": {"pressure_a": np.where(k % 3000 == 77, 0.0, a)},
        "dead": {"pressure_b": np.full(LENGTH, 101325.0)},
        "noise_alone": {"pressure_b": 3e5 + noise},
        "unplugged": {"pressure_b": noise},
        "no_number": {"pressure_a": np.full(LENGTH, np.nan)},
        "no_position": {"position": np.full(LENGTH, np.nan)},
        "some_nan": {"position": np.where(k % 2000 == 5, np.nan, y)},
        "millimetres": {"position": 1e3 * y},
        "reversed": {"position": -y},
        "wrong_sign": {"voltage": -run.voltage},
        "dead_command": {"voltage": np.full(LENGTH, 1.5)},
        "stuck": {"position": np.where(hangs, resting, y)},
        "always_stuck": {"position": resting},
        "hanging": {"position": np.where(hangs, y[START], y)},
        "hanging_pressure": {"pressure_a": np.where(hangs, a[START], a)},
    }


def write_all(folder: Path) -> Run:
    """Every recording into `folder`; returns the good one."""
    run = good_run()
    for name, changes in changed(run).items():
        bags.write(folder / name, run._replace(**changes), EPOCH)
    shutil.copytree(folder / "good", folder / "truncated")
    (part,) = (folder / "truncated").glob("*.mcap")
    part.write_bytes(part.read_bytes()[: part.stat().st_size // 2])
    (folder / "truncated" / "metadata.yaml").unlink()
    source = folder / "good"
    rewrite(source, folder / "no_pressure", keep=lambda topic, k: topic != "chamber_b/pressure")
    rewrite(source, folder / "renamed", topics={"chamber_b/pressure": "rod_side"})
    rewrite(source, folder / "gaps", keep=lambda topic, k: not START <= k < START + 1500)
    rewrite(
        source,
        folder / "pressure_gap",
        keep=lambda topic, k: topic != "chamber_a/pressure" or not START <= k < START + 1500,
    )

    rewrite(source, folder / "set_back", stamps=-3600, recorded=-3600)
    rewrite(source, folder / "set_forward", stamps=7200, recorded=7200)
    rewrite(source, folder / "stamps_jump", stamps=3600)
    return run


def rewrite(
    source: Path,
    target: Path,
    keep: Callable[[str, int], bool] = lambda topic, k: True,
    topics: dict[str, str] | None = None,
    stamps: int = 0,
    recorded: int = 0,
) -> None:
    """A recording message by message, in the order in which it was recorded.

    Each topic keeps the messages k for which `keep(topic, k)`; `topics` are new names; after three seconds the
    clocks of stamps and recorder are set by so many seconds.
    """
    names, counts = topics or {}, dict.fromkeys(bags.TOPICS, 0)
    with BagWriter(target, [BagTopic(f"/{names.get(name, name)}", kind) for name, kind in bags.TOPICS.items()]) as bag:
        for message in Bag(source).messages():
            topic = message.channel.topic.strip("/")
            later = message.log_time > EPOCH + 3 * SECOND - SECOND // 2000
            payload = moved(message.payload, stamps) if later and topic != "valve/command" else message.payload
            if keep(topic, counts[topic]):
                bag.write(f"/{names.get(topic, topic)}", message.log_time + later * recorded * SECOND, payload)
            counts[topic] += 1


def moved(payload: bytes, seconds: int) -> bytes:
    """A message with a header, stamped so much later: its seconds follow the encapsulation."""
    (stamp,) = struct.unpack_from("<i", payload, 4)
    return payload[:4] + struct.pack("<i", stamp + seconds) + payload[8:]
