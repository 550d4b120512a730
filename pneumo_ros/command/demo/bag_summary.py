"""Contents of a bag, and whether its nodes kept real time."""

from pathlib import Path

from pneumo_ros.command.console import columns

LATE = 0.01  # share of late ticks above which real time was not kept


def traffic(bag: Path) -> str:
    """Table of the topics in a bag with their counts and rates."""
    import numpy as np

    from pneumo_ros.records import Bag

    times: dict[str, list[int]] = {}
    for block in Bag(bag).blocks():
        for number in np.unique(block.channel).tolist():
            arrived = block.log_time[block.channel == number]
            times.setdefault(block.channels[number].topic, []).extend(arrived.tolist())
    rows = [("  topic", "messages", "rate")]
    for topic, stamps in sorted(times.items()):
        span = (max(stamps) - min(stamps)) * 1e-9
        rows.append((f"  {topic}", str(len(stamps)), f"{(len(stamps) - 1) / span:.1f} Hz" if span > 0.0 else ""))
    return columns(rows, right=(1, 2))


def hardship(bag: Path) -> str | None:
    """A sentence if nodes lost real time or messages, by their own diagnostics."""
    simulator, controller, recorder = (last_diagnostics(bag, name) for name in ("simulator", "controller", "recorder"))
    late = float(simulator.get("late_ticks", 0)) / max(float(simulator.get("ticks", 0)), 1.0)
    facts = {
        f"{100.0 * late:.1f} % of the simulator's ticks came over 1 ms late": late > LATE,
        "the valve closed for lack of commands": float(simulator.get("valve_closures", 0)) > 0,
        "the controller missed measurements": float(controller.get("restarts", 1)) > 1,
        "the recorder lost messages": float(recorder.get("lost_messages", 0)) > 0,
    }
    found = [fact for fact, holds in facts.items() if holds]
    if not found:
        return None
    return f"This machine was busy: {', '.join(found)}. This affects the results; try again when less is running."


def last_diagnostics(bag: Path, node: str) -> dict[str, str]:
    """The last values of a node on /diagnostics, empty if there are none."""
    from rosbags.typesys import Stores, get_typestore

    from pneumo_ros.records import Bag

    store = get_typestore(Stores.ROS2_JAZZY)
    last: dict[str, str] = {}
    for message in Bag(bag).messages():
        if message.channel.topic == "/diagnostics":
            heard = store.deserialize_cdr(message.payload, message.channel.type)
            for status in getattr(heard, "status", ()):
                if node in status.name:
                    last = {pair.key: pair.value for pair in status.values}
    return last
