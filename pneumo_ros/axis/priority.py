"""Real-time scheduling, where the system grants it."""

import os
from pathlib import Path

from pneumo_ros.axis.setting import Setting

PRIORITY = Setting(
    "real_time_priority", 10, "SCHED_FIFO priority to ask for, as root or with a limit of rtprio; 0: none",
    "", 0, 90, live=False,
)  # fmt: skip


def take_priority(priority: int) -> int:
    """Give all threads of this process SCHED_FIFO `priority`; returns what was granted, 0 if nothing was.

    Threads and processes started later have normal priority: compilers must not delay the control loop.
    """
    if priority == 0:
        return 0
    try:
        for thread in Path("/proc/self/task").iterdir():
            policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
            os.sched_setscheduler(int(thread.name), policy, os.sched_param(priority))
    except (OSError, AttributeError):  # not permitted, or no Linux
        return 0
    return priority
