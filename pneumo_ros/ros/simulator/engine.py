"""The engine of a simulator: it advances the plant, of one axis or several, and has the nodes send their samples."""

import threading
import time
from collections.abc import Callable

from pneumo_ros.axis.priority import PRIORITY, take_priority
from pneumo_ros.axis.simulator.lockstep import WATCH, Lockstep
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.simulator.stamps import WallStamps
from pneumo_ros.axis.simulator.together import Together
from pneumo_ros.axis.ticker import Ticker
from pneumo_ros.errors import NumericalError
from pneumo_ros.ros.node import AxisNode


class Engine:
    """In real time, or in lockstep with the controllers; another simulator that moves the rod makes its own steps."""

    def __init__(self, node: AxisNode, plant: Simulation | Together, *, driven: bool = False) -> None:
        """`node` has the parameters, timers and log; `driven`: another simulator makes the steps."""
        values = node.parameters
        factor = values["real_time_factor"]
        self.lock, self.plant, self._node = threading.Lock(), plant, node
        self.paused: bool = values["start_paused"]
        self.fault: str | None = None
        self.simulated_time: bool = values["publish_clock"] or factor != 1.0 or driven
        self.driven, self._stamps = driven, WallStamps()
        self._senders: list[Callable[[int], None]] = []
        self._loops: dict[str, Callable[[], bool]] = {}
        self._closed, self._answered = set[str](), set[str]()
        self._period = 1e9 / plant.rate / (factor or 1.0)  # ns of wall time
        self.lockstep = self._make_lockstep() if factor == 0.0 and not driven else None
        self.ticker = None if self.lockstep or driven else Ticker(self._period, self._tick, node.fail)

    @property
    def pace(self) -> Ticker | Lockstep | None:
        """What advances the plant; None where another simulator does."""
        return self.ticker or self.lockstep

    def serve(self, send: Callable[[int], None]) -> None:
        """Call `send` with the stamp [ns] of each sample, in the order in which this was called."""
        self._senders.append(send)

    def loop(self, axis: str, closed: Callable[[], bool]) -> None:
        """In lockstep, wait for the commands of `axis` while its loop is `closed`."""
        self._loops[axis] = closed

    def _make_lockstep(self) -> Lockstep:
        node = self._node
        lockstep = Lockstep(
            lambda: self.advance(0, 1.0),
            self.send,
            self._matched,
            lambda: self.paused,
            lambda act: node.executor.create_task(act),
            node.get_logger(),
            wait=node.parameters["lockstep_wait"],
            timeout=node.parameters["lockstep_timeout"],
        )
        node.create_timer(WATCH, lockstep.watch, clock=node.steady_clock)
        return lockstep

    def _matched(self) -> bool:
        """Whether there is something to wait for: at first all controllers, later those that are there."""
        self._closed = {axis for axis, closed in self._loops.items() if closed()}
        begun = self.lockstep is not None and self.lockstep.started
        return bool(self._closed) if begun else len(self._closed) == len(self._loops)

    def answered(self, axis: str) -> None:
        """A command of `axis` has come: in lockstep, the plant goes on when every axis has its own."""
        if self.lockstep is None:
            return
        self._answered.add(axis)
        if self._answered >= self._closed:
            self._answered.clear()
            self.lockstep.command()

    # --- samples ----------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin at the initial state."""
        self.plant.reset()
        if self.ticker:
            self.ticker.start()
            take_priority(self._node.parameters[PRIORITY.name])  # after the start: new threads do not inherit it

    def stop(self) -> None:
        """Stop the plant."""
        self.paused = True
        if self.ticker:
            self.ticker.stop()

    def single_step(self) -> None:
        """One sample while paused; with the lock held."""
        now = time.monotonic_ns()
        if self.lockstep:
            if self.advance(0, 1.0):
                self.lockstep.publish()
        elif self.advance(round(now - self._period), self._period / self.plant.plant.parts):
            self.send(now)

    def _tick(self, deadline: int) -> None:
        """The sample that ends at `deadline` [ns, CLOCK_MONOTONIC] is over: simulate it."""
        begin, part = round(deadline - self._period), self._period / self.plant.plant.parts
        with self.lock:
            if not self.paused and self.advance(begin, part):
                self.send(deadline)

    def advance(self, begin: int, part: float) -> bool:
        """One sample, see `Simulation.advance`; False, and a pause, if the state is not finite."""
        try:
            self.plant.advance(begin, part)
        except NumericalError as error:
            self.fault, self.paused = str(error), True
            self._node.get_logger().error(f"{error}; paused: call ~/reset, or change a parameter first")
        return self.fault is None

    def send(self, moment: int = 0) -> None:
        """Send the present sample, stamped with simulated time or the wall time of `moment` [ns, CLOCK_MONOTONIC]."""
        stamp = self.plant.clock if self.simulated_time else self._stamps.at(moment)
        self._answered.clear()
        for send in self._senders:
            send(stamp)
