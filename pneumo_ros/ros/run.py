"""The life of a process of nodes: start, spin in a thread, end with exit code 0 on SIGINT and SIGTERM."""

import faulthandler
import gc
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from types import TracebackType

import rclpy
from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.logging import get_logger
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from pneumo_ros.axis.stopping import STOP, listen_for_signals
from pneumo_ros.errors import PneumoError, UsageError
from pneumo_ros.ros.node import AxisNode

try:  # twice as fast; part of rclpy since Kilted
    from rclpy.experimental import EventsExecutor
except ImportError:
    EventsExecutor = None

# s in which the middleware must let nodes go: Fast DDS 3.2 may wait for its own discovery thread for ever, at full load
# and with the GIL, so that no signal is handled
LETS_GO = 60.0
POLL = 0.5  # s; EventsExecutor.spin() without a limit hangs in some builds


def make_executor() -> Executor:
    """The fastest executor this rclpy has."""
    return EventsExecutor() if EventsExecutor else SingleThreadedExecutor()


class Spinner:
    """Runs the callbacks of nodes in a thread of their own, so that the main thread can handle signals.

    An exception of a callback ends the thread; it is kept in `failure`, and `ended` is called.
    """

    def __init__(self, nodes: Sequence[AxisNode], ended: Callable[[], None]) -> None:
        self.failure: BaseException | None = None
        self._nodes, self._ended = nodes, ended
        self._executor, self._stop = make_executor(), Future()
        self._thread = threading.Thread(target=self._spin, name="executor")

    def __enter__(self) -> "Spinner":
        for node in self._nodes:
            self._executor.add_node(node)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop.set_result(None)
        self._executor.wake()
        self._thread.join()
        self._executor.shutdown()

    def _spin(self) -> None:
        try:
            while not self._stop.done():
                self._executor.spin_until_future_complete(self._stop, timeout_sec=POLL)
        except BaseException as failure:  # the main thread reports what a callback raises
            self.failure = failure
        finally:
            self._ended()


def run(make: Callable[[], Sequence[AxisNode]], name: str, ros_args: Sequence[str] | None = None) -> int:
    """Run the nodes that `make` builds until SIGINT or SIGTERM; returns the exit code of the process.

    `name` precedes messages; `ros_args` are the arguments rclpy reads, None for those of the command line. A
    PneumoError is reported in one line and gives its exit code; anything else with its traceback, and gives 1, as does
    a middleware that does not let the nodes go in LETS_GO: all they had to do is done by then.
    """
    listen_for_signals()
    try:
        _init(ros_args)
        _live(make)
    except PneumoError as error:
        print(f"{name}: error: {error}", file=sys.stderr)
        return error.exit_code
    except Exception:
        traceback.print_exc()
        return 1
    finally:
        rclpy.try_shutdown()
        faulthandler.cancel_dump_traceback_later()
    return 0


def _init(ros_args: Sequence[str] | None) -> None:
    try:
        rclpy.init(args=None if ros_args is None else list(ros_args), signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:  # RCLError and UnknownROSArgsError are no classes of rclpy's public modules
        raise UsageError(f"ROS arguments are refused: {error}") from error


def _live(make: Callable[[], Sequence[AxisNode]]) -> None:
    nodes: Sequence[AxisNode] = ()
    spinner = None
    try:
        nodes = make()
        spinner = Spinner(nodes, STOP.set)
        with spinner:
            gc.collect()
            gc.freeze()  # existing objects stay; later collections take microseconds
            for node in nodes:
                node.end = STOP.set
                node.start()
                node.get_logger().info(node.ready())
                if node.failure is not None:  # a callback has failed before `end` was known
                    node.end()
            STOP.wait()
            for node in nodes:
                node.finish()
    finally:
        faulthandler.dump_traceback_later(LETS_GO, exit=True)  # in C: it needs no GIL
        for node in nodes:
            node.destroy_node()
    if spinner.failure is not None:
        raise spinner.failure
    failed = [node.failure for node in nodes if node.failure is not None]
    if failed:
        raise failed[0]
    get_logger("pneumo_ros").debug("stopped")
