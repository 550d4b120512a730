"""FollowJointTrajectory without its transport, because control_msgs has no wheels. Loop and messages are real."""

import asyncio
import math
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace
from typing import Any

import pytest
from axis.guided import Run
from builtin_interfaces.msg import Duration
from std_msgs.msg import Header
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from pneumo_ros.axis.controller.progress import (
    GOAL_TOLERANCE_VIOLATED,
    INVALID_GOAL,
    PATH_TOLERANCE_VIOLATED,
    SUCCESSFUL,
)
from pneumo_ros.errors import UsageError
from pneumo_ros.ros.controller import action
from pneumo_ros.ros.controller.requests import waypoints_of


class Action:
    """The fields of control_msgs/action/FollowJointTrajectory that are used."""

    class Result(SimpleNamespace):
        pass

    class Feedback:
        def __init__(self) -> None:
            self.header, self.joint_names = Header(), []
            self.desired, self.actual, self.error = (JointTrajectoryPoint() for _ in range(3))


class Goal:
    """A goal and its result."""

    is_cancel_requested = False

    def __init__(self, position: float, seconds: int) -> None:
        point = JointTrajectoryPoint(positions=[position], velocities=[0.0], time_from_start=Duration(sec=seconds))
        trajectory = JointTrajectory(joint_names=["piston"], points=[point])
        self.request = SimpleNamespace(
            trajectory=trajectory, goal_tolerance=[], path_tolerance=[], goal_time_tolerance=Duration()
        )
        self.ended, self.told = "", []

    def __getattr__(self, name: str) -> Any:
        if name in ("succeed", "abort", "canceled"):
            return lambda: setattr(self, "ended", name)
        raise AttributeError(name)

    def publish_feedback(self, feedback: Any) -> None:
        """Kept."""
        self.told.append(feedback)


class Player:
    """Acts as the node: a loop whose piston follows its setpoint, unless stuck. `meanwhile` runs after 0.5 s."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, stuck: bool = False, meanwhile: Any = None) -> None:
        self.run, self.stuck, self.meanwhile, self.pauses = Run(), stuck, meanwhile, 0
        self.loop, self.inputs = self.run.loop, self
        self.parameters = {"joint_name": "piston", "goal_tolerance": 0.003}
        self.loop_now = lambda: self.loop.time
        self.get_logger = lambda: SimpleNamespace(warning=lambda text: None)
        self.get_clock = lambda: SimpleNamespace(now=lambda: SimpleNamespace(to_msg=lambda: Header().stamp))
        monkeypatch.setattr(action, "ActionServer", lambda *_, **__: None)
        monkeypatch.setattr(action.Following, "_pause", self._pause)

    def follow(self, message: JointTrajectory) -> Any:
        """As the node's inputs do."""
        return self.loop.guide.follow(waypoints_of(message, "piston"), 0.0, self.loop.time)

    async def _pause(self) -> None:
        self.pauses += 1
        assert self.pauses < 200, "it never ends"
        if self.pauses == 10 and self.meanwhile:
            self.meanwhile()
        self.run.go(50, follow=not self.stuck)

    def serve(self, goal: Goal) -> Any:
        """The result of a goal."""
        with ThreadPoolExecutor(1) as pool:  # a browser of other tests may have left its loop running in this thread
            return pool.submit(asyncio.run, action.Following(self, Action)._execute(goal)).result()


def test_a_goal_that_is_reached(monkeypatch: pytest.MonkeyPatch) -> None:
    goal = Goal(0.1, 2)
    result = Player(monkeypatch).serve(goal)
    assert (goal.ended, result.error_code) == ("succeed", SUCCESSFUL)
    assert len(goal.told) >= 35
    middle = goal.told[20]
    assert middle.joint_names == ["piston"]
    assert 0.0 < middle.actual.positions[0] < 0.1
    assert abs(middle.error.positions[0]) < 1e-3


def test_a_goal_that_cannot_be_followed_is_refused_with_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    goal = Goal(-0.5, 1)
    result = Player(monkeypatch).serve(goal)
    assert (goal.ended, result.error_code) == ("abort", INVALID_GOAL)
    assert "the piston reaches -0.147 m/s" in result.error_string


def test_a_piston_that_is_stuck(monkeypatch: pytest.MonkeyPatch) -> None:
    goal = Goal(0.1, 2)
    result = Player(monkeypatch, stuck=True).serve(goal)
    assert (goal.ended, result.error_code) == ("abort", GOAL_TOLERANCE_VIOLATED)
    goal = Goal(0.1, 2)
    goal.request.path_tolerance = [SimpleNamespace(name="piston", position=0.02)]
    assert Player(monkeypatch, stuck=True).serve(goal).error_code == PATH_TOLERANCE_VIOLATED


def test_tolerances_are_those_of_the_joint_or_the_usual_or_any() -> None:
    given = [SimpleNamespace(name="boom", position=9.0), SimpleNamespace(name="piston", position=0.02)]
    assert action.tolerance(given, "piston", 0.003) == 0.02
    assert action.tolerance(given[:1], "piston", 0.003) == 0.003
    assert action.tolerance([SimpleNamespace(name="piston", position=0.0)], "piston", 0.003) == 0.003
    assert action.tolerance([SimpleNamespace(name="piston", position=-1.0)], "piston", 0.003) == math.inf


def test_cancelling_brakes_and_stopping_aborts(monkeypatch: pytest.MonkeyPatch) -> None:
    goal = Goal(0.1, 2)
    player = Player(monkeypatch, meanwhile=lambda: setattr(goal, "is_cancel_requested", True))
    player.serve(goal)
    assert goal.ended == "canceled"
    player.run.go(1000, follow=True)
    assert 0.0 < player.run.position < 0.1
    goal = Goal(0.1, 2)
    player = Player(monkeypatch, meanwhile=lambda: player.loop.guide.close())
    result = player.serve(goal)
    assert (goal.ended, result.error_string) == ("abort", "the valve was closed")
    with pytest.raises(UsageError):
        player.follow(goal.request.trajectory)
