"""What every test shares: `import rig`, a ROS domain of its own, logs and kernels that stay out of the home folder.

A test that hangs fails after ten minutes, the longest files of tests begin first, those that wait for nodes run beside
those that compute, and the end of a run shows the seconds of every folder.
"""

import os

# Before anything imports numpy, here and in the processes that tests start: threads of BLAS wait for each other busily,
# and take a quarter of the processor time from the tests beside them.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import faulthandler
import gc
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import hypothesis
import pytest

from pneumo_ros.environment import Domain

TEST = Path(__file__).parent
sys.path.insert(0, str(TEST))  # the independent simulator under test/rig imports as `rig`

STATUS, SCREEN = pytest.StashKey[int](), pytest.StashKey[Any]()
BOUND = 600.0  # s, for one test with the fixtures that it sets up; the longest takes two minutes on a busy machine
# Files that take longest, the longest first; one that begins last would keep a single process busy at the end.
LONGEST = (
    "ros/test_identification.py", "ros/test_simulator.py", "runs/test_sensors.py", "command/test_unfit.py",
    "command/test_diagnose.py", "workbench/test_story.py", "workbench/test_plots.py", "workbench/test_jobs.py",
    "report/test_diagnosis.py", "ros/test_stack.py", "ros/test_chaos.py", "experiment/test_separate.py",
    "workbench/test_live.py", "ros/test_safety.py", "ros/test_live_round.py", "ros/test_recorder.py",
    "test_rig_recordings.py", "test_rig_effects.py", "shooting/test_refit_added.py", "diagnose/test_adding.py",
    "diagnose/test_timing.py", "reading/test_plausible.py",
)  # fmt: skip

# Folders whose tests mostly wait, for nodes and pages: three of their files at once would leave the processors idle.
WAITING = ("ros", "workbench", "urdf")

# A script's `make test &`, nohup and cron let their children ignore SIGINT: tests that send one would wait for ever.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# A busy machine is slow to draw values, and to try them; that is no fault of a test.
hypothesis.settings.register_profile(
    "busy", deadline=None, suppress_health_check=[hypothesis.HealthCheck.too_slow], database=None
)
hypothesis.settings.load_profile("busy")

# Python looks for dead cycles after every 700 objects, and numba and pytest keep millions alive.
gc.set_threshold(100_000, 20, 20)

# Before anything imports rclpy: nodes of this process, here and in child processes, see each other and nobody else.
DOMAIN = Domain()
os.environ.update(DOMAIN.environment)
os.environ.setdefault("FASTDDS_DEFAULT_PROFILES_FILE", str(TEST / "ros" / "quick_discovery.xml"))
LOGS = tempfile.TemporaryDirectory(prefix="pneumo_ros_log_")  # vanishes with the session
os.environ["ROS_LOG_DIR"] = LOGS.name
os.environ.setdefault("PNEUMO_KERNELS", str(TEST.parent / ".cache" / "kernels"))
# The wheels start Python a second time to find their libraries; a Python of another environment must do so itself.
os.environ.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)


def pytest_configure(config: pytest.Config) -> None:
    config.stash[SCREEN] = os.fdopen(os.dup(2), "w")  # while a test runs, pytest keeps what is written to 2


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    place = {path: k for k, path in enumerate(in_turn(list(dict.fromkeys(item.path for item in items))))}
    items.sort(key=lambda item: place[item.path])


def in_turn(files: Sequence[Path]) -> list[Path]:
    """Files of tests: the longest first, then those that wait, spread evenly over the others."""
    rank = {TEST / name: k for k, name in enumerate(LONGEST)}
    left = {waits: [path for path in files if path not in rank and (path.parent.name in WAITING) == waits]
            for waits in (True, False)}  # fmt: skip
    spread = sorted(((k + 0.5) / len(some), path) for some in left.values() for k, path in enumerate(some))
    return [*sorted((path for path in files if path in rank), key=rank.__getitem__), *(path for _, path in spread)]


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """After its bound a test fails; one that Python cannot interrupt then ends its process, and with it the run."""
    screen = item.config.stash[SCREEN]

    def fail(*_: object) -> None:
        faulthandler.dump_traceback(file=screen)
        pytest.fail(f"not done after {BOUND:g} s; the stacks of all threads are on stderr")

    usual = signal.signal(signal.SIGALRM, fail)
    signal.setitimer(signal.ITIMER_REAL, BOUND, BOUND / 10.0)  # again, where a fixture hangs at its end
    faulthandler.dump_traceback_later(2.0 * BOUND, exit=True, file=screen)
    yield
    faulthandler.cancel_dump_traceback_later()
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, usual)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Seconds of the tests of every folder."""
    seconds: Counter[str] = Counter()
    for report in (one for kind in ("passed", "failed", "skipped", "") for one in terminalreporter.getreports(kind)):
        seconds[report.nodeid.partition("::")[0].rpartition("/")[0]] += getattr(report, "duration", 0.0)
    if sum(seconds.values()) > 60.0:
        terminalreporter.write_sep("=", "seconds of each folder")
        for folder, total in seconds.most_common():
            terminalreporter.write_line(f"{total:7.1f} s  {folder}")


def pytest_sessionfinish(session: pytest.Session, exitstatus: int) -> None:
    session.config.stash[STATUS] = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Where the middleware locked up in a test's own node, the process would wait for it at its end for ever."""
    probes = sys.modules.get("ros.probe")
    if probes is not None and probes.LEFT_BEHIND:
        sys.stdout.flush()
        os._exit(config.stash.get(STATUS, 1))


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """A running browser for all tests that need one; they are skipped, with the reason, where there is none."""
    from report.browser import chromium

    with chromium() as running:
        yield running
