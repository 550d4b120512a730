"""Memory of the C library: one heap that all threads share.

GNU's malloc gives each thread a heap of its own, which keeps what its largest task took. A diagnosis of 140 s of
recordings at 1 kHz took 904 MB with one for each of its threads, and 723 MB with one for all, in the same time.
"""

import ctypes

M_ARENA_MAX = -8  # of malloc.h


def share_one_heap() -> bool:
    """Let all threads of this process that have no heap yet share one; False where the C library has no such setting.

    Results do not depend on it.
    """
    try:
        return bool(ctypes.CDLL(None).mallopt(M_ARENA_MAX, 1))
    except (AttributeError, OSError, TypeError):  # another C library than GNU's
        return False
