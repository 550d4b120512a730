"""Work that a first Ctrl-C does not stop, because it completes the results so far; and work that has a deadline."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

from pneumo_ros.errors import OutOfTimeError


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

    def out_of_time(number: int, frame: FrameType | None) -> None:
        raise OutOfTimeError

    before = signal.signal(signal.SIGALRM, out_of_time)
    # not the timer of the process, which may be somebody else's
    timer = threading.Timer(max(seconds, 0.0), signal.pthread_kill, (threading.get_ident(), signal.SIGALRM))
    timer.daemon = True
    try:
        timer.start()
        yield
    finally:
        try:
            timer.cancel()
            timer.join()
        finally:
            signal.signal(signal.SIGALRM, before)
