"""Faults while the piston moves: simulator and controller as processes, started once for all tests."""

import math
import signal
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from ros.axis_probe import AxisProbe
from ros.processes import Running, node, running
from sensor_msgs.msg import FluidPressure

from pneumo_ros.control.motion.limits import Limits

PLACE = "safety"
RATE = 200.0  # Hz


class Rig:
    """The processes, and the probe that watches them."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self._folder, self._stack = folder, stack
        self.simulator, self.controller = self.start("simulator", publish_rate=RATE), self.start("controller")
        self.probe = AxisProbe(PLACE)
        stack.callback(self.probe.close)
        self.probe.wait(lambda: self.probe.heard["valve/command"], "a command")

    def start(self, name: str, **parameters: object) -> Running:
        """A node of this package in the namespace."""
        command = node(name, "-r", f"__ns:=/{PLACE}", **parameters)
        return self._stack.enter_context(running(*command, cwd=self._folder))

    def moving(self) -> AxisProbe:
        """The probe, when the piston moves towards the far side of the middle."""
        one = self.probe
        assert one.trigger("controller/resume").success
        one.aim(-0.4 if one.position > 0.0 else 0.4)
        one.wait(lambda: one.speed > 0.08, "motion")
        return one


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    """Simulator and controller, and at their end exit code 0."""
    with ExitStack() as stack:
        rig = Rig(tmp_path_factory.mktemp("safety"), stack)
        yield rig
        assert [rig.controller.end(), rig.simulator.end()] == [0, 0], rig.controller.said


def test_a_lost_supply_closes_the_valve_and_its_return_moves_nothing(rig: Rig) -> None:
    one = rig.moving()
    one.supply(7e5)
    assert one.set("simulator", air__supply_pressure=1.2e5) == (True, "")
    one.supply(1.2e5)
    one.wait(lambda: one.voltage == 0.0, "0 V")
    message, _ = one.health(f"{PLACE}/controller")
    assert "supply pressure lost" in message
    one.comes_to_rest()
    assert one.set("simulator", air__supply_pressure=7e5) == (True, "")
    one.supply(7e5)
    one.rests(0.5)
    one.supply(math.nan)
    one.supply(7e5)
    assert rig.moving()  # and reaches its goal


def test_vent_empties_both_chambers_of_a_supply_that_is_shut_off(rig: Rig) -> None:
    one = rig.moving()
    one.supply(7e5)
    assert not one.trigger("controller/vent").success
    assert one.set("simulator", air__supply_pressure=1e5) == (True, "")
    one.supply(1e5)
    assert one.trigger("controller/vent").success
    chambers = [f"chamber_{c}/pressure" for c in "ab"]
    for topic in chambers:
        one.wait(lambda topic=topic: one.heard[topic][-1].fluid_pressure < 1.2e5, f"an empty chamber ({topic})")
    one.supply(7e5)
    one.wait(lambda: one.voltage == 0.0, "0 V, or the supply would drive the piston")
    assert one.set("simulator", air__supply_pressure=7e5) == (True, "")
    one.rests(0.3)


def test_a_stream_that_breaks_off_ends_at_its_last_position(rig: Rig) -> None:
    one = rig.probe
    assert one.trigger("controller/resume").success
    one.comes_to_rest()
    begin, last = one.position, 0.0
    side = -1.0 if begin > 0.0 else 1.0
    for tick in range(50):
        last = begin + side * 0.08 * 0.01 * tick
        one.command_joints(["piston"], [last], [side * 0.08])
        time.sleep(0.01)
    one.arrives(last)
    assert "the last position is held" in one.health(f"{PLACE}/controller")[1]["reason"]


def test_stop_brakes_over_the_distance_that_it_states(rig: Rig) -> None:
    one = rig.moving()
    answer = one.trigger("controller/stop")
    begin = one.position
    assert answer.success
    stated = 1e-3 * float(answer.message.partition("after ")[2].partition(" mm")[0])
    assert 0.005 < stated < 0.06
    one.wait(lambda: one.voltage == 0.0, "a closed valve")
    one.comes_to_rest()
    assert abs(one.position - begin) < 1.5 * stated + 0.01  # it coasted 248 mm when the valve was closed at once
    assert "stopped" in one.health(f"{PLACE}/controller")[0]


def test_what_no_machine_is_is_refused_while_it_runs(rig: Rig) -> None:
    one = rig.probe
    for name, value, words in (
        ("lugre_friction__static_friction", 10.0, "is below Coulomb friction"),
        ("air__supply_pressure", 5e4, "is absolute"),
        ("use_sim_time", True, "use_sim_time stays false here"),
    ):
        done, why = one.set("simulator", **{name: value})
        assert (done, words in why) == (False, True), why


def test_a_simulator_that_is_killed_and_started_again(rig: Rig) -> None:
    one = rig.moving()
    rig.simulator.process.kill()
    rig.controller.wait_for("no measurement for 0.1 s: sending 0 V")
    commands, states = one.heard["valve/command"], one.heard["joint_states"]
    known = len(states)
    rig.simulator = rig.start("simulator", publish_rate=RATE, **{"initial.y": 0.1})
    rig.controller.wait_for("measurements are back")
    one.wait(lambda: len(states) > known and abs(commands[-1].data) > 0.5, "motion to where it was sent")
    speeds = [abs(state.velocity[0]) for state in list(states)[known:]]
    assert max(speeds) < 3.0 * Limits().speed  # the motion starts where the piston is: a profile, no jump
    assert rig.moving()


def test_a_controller_that_is_killed_and_started_again(rig: Rig) -> None:
    one = rig.moving()
    rig.controller.process.send_signal(signal.SIGKILL)
    one.wait(
        lambda: one.health(f"{PLACE}/simulator")[1]["voltage_V"] == "0", "a closed valve", 3.0
    )  # command_timeout, and a look each second
    one.comes_to_rest()
    rig.controller = rig.start("controller")
    rig.controller.process.poll()
    have = len(one.heard["valve/command"])
    one.wait(lambda: len(one.heard["valve/command"]) > have, "commands of the new one")
    one.rests(0.3)  # it has no reference
    assert "no reference yet" in one.health(f"{PLACE}/controller")[0]


WORST = [
    {"pid.proportional": 10000.0, "pid.integral": 10000.0, "pid.derivative": 1000.0, "pid.integral_limit": 10.0},
    {"pid.proportional": 0.0, "pid.integral": 0.0, "pid.derivative": 0.0},
    {"profile.speed": 10.0, "profile.acceleration": 1000.0, "profile.jerk": 1e6, "following_error": 100.0},
    {"profile.speed": 1e-4, "profile.acceleration": 1e-3, "profile.jerk": 1e-2, "following_error": 1e-3},
    {"max_voltage": 0.79, "measurement_timeout": 0.06, "valve.smoothing": 10.0},
    {"limits.low": -0.01, "limits.high": 0.01, "minimum_supply": 0.0},
]


def test_parameters_at_their_worst_under_way(rig: Rig) -> None:
    """The piston stays off the ends of the stroke, commands are within the limit, and the settings can be undone."""
    one = rig.probe
    for worst in WORST:
        rig.moving()
        usual = {name: one.get("controller", name) for name in worst}
        given = {name.replace(".", "__"): value for name, value in worst.items()}
        have = len(one.heard["valve/command"])
        assert one.set("controller", **given) == (True, "")
        time.sleep(0.3)
        commands = [message.data for message in one.heard["valve/command"][have:]]
        assert all(math.isfinite(volts) and abs(volts) <= 10.0 for volts in commands)
        assert abs(one.position) < 0.9
        back = {name.replace(".", "__"): value for name, value in usual.items()}
        assert one.set("controller", **back) == (True, "")
    assert not one.set("controller", limits__low=0.5, limits__high=0.4)[0]
    assert not one.set("controller", limits__low=1.5)[0]  # beyond the stroke: no room is left
    assert not one.set("controller", reference__shape="constant", reference__position=1.2)[0]
    one.aim(0.0)
    one.arrives(0.0)


def test_values_that_are_not_numbers_change_nothing(rig: Rig) -> None:
    one = rig.probe
    one.comes_to_rest()
    before = int(one.health(f"{PLACE}/controller")[1]["rejected_inputs"])
    one.publisher(FluidPressure, "supply/pressure").publish(FluidPressure(fluid_pressure=math.nan))
    one.aim(math.nan)
    one.trajectory([(1.0, math.inf, 0.0)])
    one.command_joints(["piston"], [-math.inf])
    one.send(math.nan)  # straight to the valve
    one.wait(lambda: int(one.health(f"{PLACE}/controller")[1]["rejected_inputs"]) >= before + 4, "four refusals")
    assert "refused" in rig.simulator.said
    one.rests(0.2)
