"""What every test shares: `import rig`, a ROS domain of its own, logs and kernels that stay out of the home folder."""

import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from pneumo_ros.environment import Domain

TEST = Path(__file__).parent
sys.path.insert(0, str(TEST))  # the independent simulator under test/rig imports as `rig`

STATUS = pytest.StashKey[int]()

# Before anything imports rclpy: nodes of this session, here and in child processes, see each other and nobody else.
DOMAIN = Domain()
os.environ.update(DOMAIN.environment)
os.environ.setdefault("FASTDDS_DEFAULT_PROFILES_FILE", str(TEST / "ros" / "quick_discovery.xml"))
LOGS = tempfile.TemporaryDirectory(prefix="pneumo_ros_log_")  # vanishes with the session
os.environ["ROS_LOG_DIR"] = LOGS.name
os.environ.setdefault("PNEUMO_KERNELS", str(TEST.parent / ".cache" / "kernels"))
# The wheels start Python a second time to find their libraries; a Python of another environment must do so itself.
os.environ.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)


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
