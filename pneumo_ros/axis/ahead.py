"""Reading ahead: another thread makes the items of an iterator before they are needed."""

import threading
from collections.abc import Iterable, Iterator
from itertools import islice
from queue import Full, Queue
from typing import TypeVar

T = TypeVar("T")
BATCH = 256  # items handed over at a time
WAIT = 0.1  # s between two checks that the reader is still there


def ahead(items: Iterable[T], batches: int = 64) -> Iterator[T]:
    """The same items in the same order; up to `batches` times BATCH of them are ready early.

    An exception of `items` is raised here, after the items before it.
    """
    queue: Queue[list[T] | BaseException] = Queue(maxsize=batches)
    over = threading.Event()
    thread = threading.Thread(target=_fill, args=(queue, iter(items), over), name="reading ahead", daemon=True)
    thread.start()
    try:
        while batch := queue.get():
            if isinstance(batch, BaseException):
                raise batch
            yield from batch
    finally:
        over.set()


def _fill(queue: "Queue[list[T] | BaseException]", items: Iterator[T], over: threading.Event) -> None:
    """Put batches; the last one is empty, or the exception that ended the items."""
    more = True
    while more and not over.is_set():
        try:
            batch: list[T] | BaseException = list(islice(items, BATCH))
        except BaseException as failure:  # the reader raises it again
            batch = failure
        more = bool(batch) and not isinstance(batch, BaseException)
        _put(queue, batch, over)


def _put(queue: "Queue[list[T] | BaseException]", batch: "list[T] | BaseException", over: threading.Event) -> None:
    while not over.is_set():
        try:
            queue.put(batch, timeout=WAIT)
            return
        except Full:
            continue
