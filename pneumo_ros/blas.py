"""Linear algebra of numpy and scipy on one thread.

The matrices of a fit have a few dozen columns. Threads that share such a product wait for each other longer than they
compute, and they wait busily: they take processor time from the simulations, and from other programs.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any


@contextmanager
def on_one_thread() -> Iterator[None]:
    """Within it, and within a function that it decorates, BLAS uses one thread, in the whole process.

    Results do not depend on it. Without threadpoolctl it changes nothing.
    """
    libraries = _libraries()
    if libraries is None:
        yield
        return
    with libraries.limit(limits=1, user_api="blas"):
        yield


@cache
def _libraries() -> Any:
    """The libraries that this process has loaded, whose threads can be limited; None without threadpoolctl."""
    try:
        from threadpoolctl import ThreadpoolController
    except ImportError:
        return None
    return ThreadpoolController()
