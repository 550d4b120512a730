"""Simulators and controllers as processes: each piston reaches its goal."""

import signal
from contextlib import ExitStack
from functools import partial
from pathlib import Path

from ros.probe import Probe, probe
from ros.processes import node, running


def settled(one: Probe, wanted: float) -> bool:
    """Whether the last half second was within 2 mm of the reference."""
    last = [message.position[0] for message in one.heard["joint_states"][-250:]]
    return len(last) == 250 and max(abs(y - wanted) for y in last) < 2e-3


def test_two_cylinders_at_once_each_go_where_they_should(tmp_path: Path) -> None:
    wanted = {"left": 0.08, "right": -0.05}
    with ExitStack() as stack:
        processes, probes = [], {}
        for name, position in wanted.items():
            place = ("-r", f"__ns:=/{name}")
            steady = {"reference.shape": "constant", "reference.position": position}
            sensors = {"noise_position": 5e-6, "quantisation_position": 1e-5, "publish_velocity": False}
            for command in (
                node("simulator", *place, joint_name=f"{name}_piston", **sensors),
                node("controller", *place, joint_name=f"{name}_piston", **steady),
            ):
                processes.append(stack.enter_context(running(*command, cwd=tmp_path)))
            probes[name] = stack.enter_context(probe(name))
        for name, one in probes.items():
            one.wait(partial(settled, one, wanted[name]), f"rest at {wanted[name]} m")
            message = one.heard["joint_states"][-1]
            assert list(message.name) == [f"{name}_piston"]
            assert len(message.velocity) == 0
        assert [process.end(signal.SIGINT) for process in reversed(processes)] == [0, 0, 0, 0]
