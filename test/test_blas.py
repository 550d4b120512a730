"""Linear algebra runs on one thread while a diagnosis works, and on as many as before afterwards."""

import sys
from collections.abc import Iterator

import numpy as np
import pytest

from pneumo_ros import blas

threadpoolctl = pytest.importorskip("threadpoolctl", reason="without it, only more processor time is used")


@pytest.fixture(autouse=True)
def two_threads() -> Iterator[None]:
    """BLAS on two threads, whatever the tests' environment says; libraries are looked for again."""
    blas._libraries.cache_clear()
    with threadpoolctl.threadpool_limits(2, user_api="blas"):
        yield
    blas._libraries.cache_clear()


def threads() -> set[int]:
    """Numbers of threads of the BLAS libraries of this process."""
    np.linalg.inv(np.eye(2))  # at least one is loaded
    return {one["num_threads"] for one in threadpoolctl.threadpool_info() if one["user_api"] == "blas"}


def test_a_decorated_function_has_one_thread_and_gives_the_others_back() -> None:
    before = threads()
    assert before == {2}
    assert blas.on_one_thread()(threads)() == {1}
    assert threads() == before


def test_they_come_back_after_an_error() -> None:
    with pytest.raises(KeyboardInterrupt), blas.on_one_thread():
        raise KeyboardInterrupt
    assert threads() == {2}


def test_without_threadpoolctl_nothing_changes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "threadpoolctl", None)
    with blas.on_one_thread():
        assert threads() == {2}
