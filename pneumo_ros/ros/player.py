"""The player node: a recording as live topics, with its original bytes and timing."""

import sys
import threading
import time
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from rclpy.time import Time
from rosgraph_msgs.msg import Clock

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.playback import Playback
from pneumo_ros.axis.priority import PRIORITY, take_priority
from pneumo_ros.axis.rig import SETTINGS as RIG
from pneumo_ros.axis.roles import CONTROLLER, PLANT
from pneumo_ros.axis.setting import Setting
from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records import Bag
from pneumo_ros.records.bag import Message, Overview
from pneumo_ros.ros.arguments import parse
from pneumo_ros.ros.node import AxisNode
from pneumo_ros.ros.outputs import Outputs
from pneumo_ros.ros.replayed import ReplayedCommands
from pneumo_ros.ros.run import run

CLOCK = "/clock"
_CLAIMS = tuple(f"claims/{role.name}" for role in (PLANT, CONTROLLER))
SWITCH_INTERVAL = 5e-4  # s; Python's own 5 ms would let reading ahead delay a message
POLL = 0.02  # s between two looks for subscribers
SETTLE = 0.3  # s; a subscriber may find its publisher later than the publisher finds it
WATCH = 1.0  # s between two looks for a rig beside recorded commands
LATE = 0.02  # s of delay from which a late message is reported

SETTINGS = (
    Setting("input", "", "recording to play: a rosbag2 folder, or an .mcap or .db3 file", live=False),
    Setting("topics", ["*"], "topics to play, named as recorded; * and ? match any letters", live=False),
    Setting("rate", 1.0, "seconds of the recording that pass in one second", "", 1e-3, 1e3, live=False),
    Setting("start_offset", 0.0, "time to skip at the start; latched topics are still sent", "s", 0.0, live=False),
    Setting("loop", False, "begin again at the end", live=False),
    Setting("publish_clock", False, "send the recorded time on /clock", live=False),
    Setting("wait", 3.0, "longest wait for a subscriber to every topic before the start", "s", 0.0, 3600.0, live=False),
    *(setting for setting in RIG if setting.name != "read_as"),
    PRIORITY,
)


class Player(AxisNode):
    """Plays the recording `input` and ends the process at its end, unless `loop` is set."""

    def __init__(self) -> None:
        super().__init__("player", SETTINGS)
        self.parameters.refuse_unknown()
        if not self.parameters["input"]:
            raise UsageError("no recording given; type: ros2 run pneumo_ros player --ros-args -p input:=FOLDER")
        bag = Bag(Path(self.parameters["input"]).expanduser())
        overview = bag.overview()
        for sentence in bag.warnings:
            self.get_logger().warning(sentence)
        self._check(overview)
        self._clock_output = self.create_publisher(Clock, CLOCK, 10) if self.parameters["publish_clock"] else None
        chosen = self._chosen(bag.path, overview)
        self._outputs = Outputs(self, [overview.channels[topic] for topic in chosen])
        self._commands = ReplayedCommands(self, self._outputs, chosen, self.parameters.values())
        self._playback = Playback(
            bag, overview, self._outputs.__contains__, self.parameters["rate"], self.parameters["start_offset"]
        )
        self._duration = (overview.end - overview.start) * 1e-9
        self._rounds = 0
        self._thread = threading.Thread(target=self._play, name="playback")
        self.create_timer(WATCH, self._watch, clock=self.steady_clock)

    def start(self) -> None:
        """Begin to play."""
        topics = len(self._outputs.names)
        self.get_logger().info(f"playing {self.parameters['input']}: {self._duration:.1f} s of {topics} topics")
        self._thread.start()

    def health(self) -> Health:
        """Position in the recording, and delay of messages."""
        playback = self._playback
        late = playback.behind * 1e-9
        values = {
            "position_s": (playback.position - playback.begin) * 1e-9 + self.parameters["start_offset"],
            "duration_s": self._duration,
            "rounds": self._rounds,
            "messages": playback.sent,
            "latest_message_late_s": late,
        }
        return Health(values, [f"a message came {late:.3f} s late"] if late > LATE else [])

    def finish(self) -> None:
        """Stop playing."""
        self._playback.stop.set()
        if self._thread.is_alive():
            self._thread.join()
        late = self._playback.behind * 1e-6
        self.get_logger().info(f"played {self._playback.sent} messages, none more than {late:.1f} ms late")

    def _play(self) -> None:
        """The thread that plays: waits for subscribers, plays once or for ever, ends the process."""
        try:
            take_priority(self.parameters[PRIORITY.name])
            self._await_subscribers()
            self._watch()
            while not self._playback.stop.is_set():
                self._playback.play(self._send, self._tick if self._clock_output else None)
                self._rounds += 1
                if not self.parameters["loop"]:
                    break
            self._commands.close()
            self._outputs.flush()
            self.end()
        except Exception as failure:  # the main thread reports it
            self.fail(failure)

    def _watch(self) -> None:
        """End where a rig would get recorded commands and nobody has said which signal closes its valve."""
        if self.failure is None and (refusal := self._commands.refusal()):
            self._playback.stop.set()
            self.fail(UsageError(refusal))

    def _await_subscribers(self) -> None:
        """Wait for discovery: a subscriber that has not found this node misses the first messages."""
        deadline = time.monotonic() + self.parameters["wait"]
        while time.monotonic() < deadline and not self._playback.stop.is_set():
            if self._outputs.heard():
                self._playback.stop.wait(SETTLE)
                return
            self._playback.stop.wait(POLL)

    def _send(self, message: Message) -> None:
        self._outputs.send(message.channel.topic, message.payload)

    def _tick(self, recorded: int) -> None:
        if self._clock_output:
            self._clock_output.publish(Clock(clock=Time(nanoseconds=recorded).to_msg()))

    def _check(self, overview: Overview) -> None:
        """Raises UsageError when nothing would be left to play."""
        offset, duration = self.parameters["start_offset"], (overview.end - overview.start) * 1e-9
        if offset > duration:
            raise UsageError(f"start_offset is {offset:g} s, but the recording lasts {duration:.3f} s")

    def _chosen(self, path: Path, overview: Overview) -> list[str]:
        """Recorded topics that match the parameter `topics`. Raises DataError for a pattern that matches none."""
        chosen: set[str] = set()
        for pattern in self.parameters["topics"]:
            matching = {name for name in overview.channels if fnmatchcase(name.lstrip("/"), pattern.lstrip("/"))}
            if not matching:
                raise DataError(f"{path}: {unknown_name('topic', pattern, overview.channels)}")
            chosen |= matching
        chosen -= {name for name in chosen if name.endswith(_CLAIMS)}  # of nodes that ran then
        if self.parameters["publish_clock"]:
            chosen.discard(CLOCK)  # there can be one clock only
        return sorted(chosen)


def main(args: Sequence[str] | None = None) -> int:
    """Run the player; returns the exit code of the process."""
    given = parse("player", "Play a recording as live topics.", SETTINGS, args)
    sys.setswitchinterval(SWITCH_INTERVAL)
    return run(lambda: [Player()], "player", given.ros)


if __name__ == "__main__":
    sys.exit(main())
