"""The processes that faults happen to: a simulated axis under control, recorded, identified, and watched by a probe."""

import math
import os
import shutil
import signal
import time
from collections.abc import Callable
from contextlib import ExitStack, suppress
from pathlib import Path
from random import Random

from ros.axis_probe import AxisProbe
from ros.processes import Running, node, running

from pneumo_ros.errors import DataError
from pneumo_ros.records import read_topics

PLACE = "chaos"
MARK = "chaos"  # frame of messages that a fault sends, to distinguish them from the simulator's
RATE = 200.0  # Hz of the simulator
ANSWER = 60.0  # s within which every node publishes again: generous, because the machine may halt for a while
BEGIN = 240.0  # s until the first state: all of them start at once
OPTIONS: dict[str, dict[str, object]] = {
    "simulator": {"publish_rate": RATE},
    "controller": {"reference.shape": "sine", "reference.amplitude": 0.3, "reference.frequency": 0.2},
    "identification": {"quiet": 0.0},
    "recorder": {},
}


class BrokenError(AssertionError):
    """A condition that must hold is violated."""


def hold(condition: object, words: str) -> None:
    """BrokenError with `words` unless `condition`."""
    if not condition:
        raise BrokenError(words)


class Field:
    """Simulator, controller, recorder and identification in one namespace, each restarted when a fault killed it."""

    def __init__(self, folder: Path, seed: int, stack: ExitStack) -> None:
        """Starts everything; `stack` ends it."""
        self.folder, self.random, self._stack = folder, Random(seed), stack
        self.nodes: dict[str, Running] = {}
        self.bags: list[Path] = []
        self.losses: list[float] = []  # s, of recorders that were killed
        self.counts = {"recorded": 0}
        (folder / "runs").mkdir(parents=True)
        for name in OPTIONS:
            self.start(name)
        self.probe = AxisProbe(PLACE)
        stack.callback(self.probe.close)
        self.until(lambda: self.probe.heard["joint_states"], "no simulator began", BEGIN)
        self.answers()

    def start(self, name: str, **more: object) -> Running:
        """Start node `name`, after it ended or for the first time."""
        options = {**OPTIONS.get(name, {}), **more}
        if name == "recorder":
            self.bags.append(self.folder / f"bag_{len(self.bags)}")
            options = {"output": self.bags[-1], **options}
        if name == "identification":
            options |= {"folder": self.folder / "runs", "output": self.folder / "identified"}
        self.nodes[name] = self.run(name, **options)
        return self.nodes[name]

    def run(self, name: str, **options: object) -> Running:
        """One more process in the namespace, which is not checked."""
        command = node(name, "-r", f"__ns:=/{PLACE}", **options)
        return self._stack.enter_context(running(*command, cwd=self.folder))

    def kill(self, name: str, number: int = signal.SIGKILL) -> float:
        """End a node by a signal; the time at which it was sent [ns since the epoch]."""
        sent = time.time_ns()
        self.nodes[name].process.send_signal(number)
        code = self.nodes[name].process.wait(ANSWER)
        hold(code == (-signal.SIGKILL if number == signal.SIGKILL else 0), f"{name} ended with {code}")
        return sent

    # --- what must hold after every fault ---------------------------------------------------------------------------

    def answers(self) -> None:
        """Every node runs and publishes, and all values of the simulator and the controller are finite."""
        for name, process in self.nodes.items():
            hold(process.process.poll() is None, f"{name} ended: {process.said[-500:]}")
        have = {topic: len(self.probe.heard[topic]) for topic in ("joint_states", "valve/command")}
        for topic, count in have.items():
            owner = "simulator" if topic == "joint_states" else "controller"
            self.until(
                lambda topic=topic, count=count: self.spoken(topic, count),
                lambda topic=topic, owner=owner: f"{topic} fell silent; {owner} said: {self.nodes[owner].said[-500:]}",
            )
        for name in self.nodes:
            with suppress(AssertionError):
                self.probe.health(f"{PLACE}/{name}")
                continue
            raise BrokenError(f"no diagnostics of {name}: {self.nodes[name].said[-500:]}")
        self.finite()

    def spoken(self, topic: str, since: int) -> bool:
        """Whether a message arrived that was not sent by a fault."""
        return any(not self.foreign(message) for message in self.probe.heard[topic][since:])

    @staticmethod
    def foreign(message: object) -> bool:
        """Whether a fault has sent a message; valve commands carry no sender."""
        header = getattr(message, "header", None)
        return header is not None and header.frame_id == MARK

    def finite(self) -> None:
        """Joint states, pressures: numbers all; then the lists are emptied."""
        for topic in ("joint_states", "chamber_a/pressure", "chamber_b/pressure"):
            for message in [one for one in self.probe.heard[topic] if not self.foreign(one)]:
                values = [*message.position, *message.velocity, *message.effort] if topic == "joint_states" else [
                    message.fluid_pressure
                ]  # fmt: skip
                hold(values and all(map(math.isfinite, values)), f"{topic} holds {values}")
            del self.probe.heard[topic][:-1]
        del self.probe.heard["/diagnostics"][:-20], self.probe.heard["valve/command"][:-1]

    def until(self, condition: Callable[[], object], words: str | Callable[[], str], seconds: float = ANSWER) -> None:
        """Wait until `condition` holds; BrokenError with `words` when it does not in time."""
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() >= end:
                raise BrokenError(f"{words() if callable(words) else words}; for {seconds:g} s")
            time.sleep(0.01)

    def closed(self, seconds: float = 4.0) -> None:
        """The simulator closes its valve; it reports this once a second."""
        end = time.monotonic() + seconds
        while self.probe.health(f"{PLACE}/simulator")[1]["voltage_V"] != "0":
            hold(time.monotonic() < end, "the valve stayed open")

    def whole(self, bag: Path, killed: float | None = None) -> None:
        """A recording is readable; one whose recorder was killed at `killed` [ns] lacks no more than a second."""
        try:
            topics = read_topics(bag)
        except DataError as error:  # killed before anything was written
            hold(killed is not None and "holds no" in str(error), str(error))
            return
        self.counts["recorded"] += sum(map(len, topics.values()))
        if killed is not None and f"/{PLACE}/joint_states" in topics:
            lost = (killed - int(topics[f"/{PLACE}/joint_states"].log_time[-1])) * 1e-9
            self.losses.append(max(lost, 0.0))
            hold(lost < 1.0, f"the killed recorder lost {lost:.2f} s")
        for part in self.folder.rglob("*.part"):
            hold(False, f"half a file: {part}")
        shutil.rmtree(bag)

    def end(self) -> None:
        """All nodes end with exit code 0."""
        for name in reversed(self.nodes):
            code = self.nodes[name].end(signal.SIGINT)
            hold(code == 0, f"{name} ended with {code}: {self.nodes[name].said[-500:]}")
        self.whole(self.bags[-1])


def is_root() -> bool:
    """Whether file systems can be mounted here."""
    return os.geteuid() == 0
