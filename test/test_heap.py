"""Threads share one heap, so that what one of them lets go serves the others."""

import subprocess
import sys
from platform import libc_ver

import pytest

from pneumo_ros.heap import share_one_heap

HEAPS = """
import ctypes, threading
import numpy as np
from pneumo_ros.heap import share_one_heap

if {shared}:
    share_one_heap()
libc, together = ctypes.CDLL(None), threading.Barrier(4)

def take():
    together.wait()
    kept = [np.ones(1000) for _ in range(100)]
    together.wait()

threads = [threading.Thread(target=take) for _ in range(4)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
libc.fdopen.restype = ctypes.c_void_p
out = ctypes.c_void_p(libc.fdopen(1, b"w"))
libc.malloc_info(0, out)
libc.fflush(out)
"""


@pytest.mark.skipif(libc_ver()[0] != "glibc", reason="GNU's malloc alone has a heap for each thread")
def test_threads_share_one_heap() -> None:
    counts = []
    for shared in (False, True):
        done = subprocess.run(
            [sys.executable, "-c", HEAPS.format(shared=shared)], check=True, capture_output=True, text=True
        )
        counts.append(done.stdout.count("<heap nr="))
    assert counts[0] > 1 == counts[1]


def test_another_c_library_is_left_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("ctypes.CDLL", lambda name: object())
    assert share_one_heap() is False
