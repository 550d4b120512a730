"""Work that a first Ctrl-C does not stop, because it completes the results so far; and work that has a deadline."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from pneumo_ros.errors import OutOfTimeError

_SOON = 0.02  # s after which a deadline that came at a bad moment is tried again


@contextmanager
def finishing(say: Callable[[], None]) -> Iterator[None]:
    """Inside the block, the first Ctrl-C calls `say`, the second one interrupts."""
    if threading.current_thread() is not threading.main_thread():  # signals go to the main thread
        yield
        return
    before = signal.getsignal(signal.SIGINT)

    def first(number: int, frame: FrameType | None) -> None:
        signal.signal(signal.SIGINT, before)
        say()

    signal.signal(signal.SIGINT, first)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def deadline(seconds: float) -> Iterator[None]:
    """Raises OutOfTimeError inside the block after so many seconds, at once if there are none; never if infinite.

    Only in the main thread, which is the one that signals interrupt.
    """
    if seconds == float("inf"):
        yield
        return

    thread, timers = threading.get_ident(), list[threading.Timer]()

    def ring(after: float) -> None:
        # not the timer of the process, which may be somebody else's
        timers.append(threading.Timer(after, signal.pthread_kill, (thread, signal.SIGALRM)))
        timers[-1].daemon = True
        timers[-1].start()

    def out_of_time(number: int, frame: FrameType | None) -> None:
        if _called_by_compiler(frame):
            ring(_SOON)
            return
        raise OutOfTimeError

    before = signal.signal(signal.SIGALRM, out_of_time)
    try:
        ring(max(seconds, 0.0))
        yield
    finally:
        try:
            for timer in timers:
                timer.cancel()
                timer.join()
        finally:
            signal.signal(signal.SIGALRM, before)


def _called_by_compiler(frame: FrameType | None) -> bool:
    """Whether the compiler calls back Python here, to keep what it compiled: what is raised there is lost."""
    while frame is not None:
        if frame.f_code.co_name.startswith("_raw_object_cache"):
            return True
        frame = frame.f_back
    return False
