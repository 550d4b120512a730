"""Faults in processes: killed, stopped for a while, doubled, and random parameter changes during motion."""

import signal
import time
from collections.abc import Callable
from typing import Any

from rcl_interfaces.msg import ParameterType

from chaos.field import OPTIONS, Field, hold

PAUSE = 0.7  # s that a process is stopped


def kill_simulator(field: Field) -> None:
    """kill -9: the controller sends 0 V; it controls the restarted simulator."""
    field.kill("simulator")
    field.until(lambda: field.probe.voltage == 0.0, "commands went on without measurements")
    field.start("simulator")


def kill_controller(field: Field) -> None:
    """kill -9: the simulator closes its valve."""
    field.kill("controller")
    field.closed()
    field.start("controller")


def kill_recorder(field: Field) -> None:
    """kill -9: everything recorded until a second before is readable."""
    field.until(lambda: field.bags[-1].exists(), "no recording appeared")
    time.sleep(field.random.uniform(0.0, 1.5))
    field.whole(field.bags[-1], field.kill("recorder"))
    field.start("recorder")


def kill_identification(field: Field) -> None:
    """kill -9, perhaps while it works."""
    field.kill("identification")
    field.start("identification")


def end_and_restart(field: Field) -> None:
    """Ctrl-C or SIGTERM for any node: exit code 0, and a recording is whole."""
    name = field.random.choice(list(OPTIONS))
    field.kill(name, field.random.choice((signal.SIGINT, signal.SIGTERM)))
    if name == "recorder":
        field.whole(field.bags[-1])
    field.start(name)


def stop_and_continue(field: Field) -> None:
    """A process that is stopped for a while, as by a debugger."""
    name = field.random.choice(list(OPTIONS))
    process = field.nodes[name].process
    process.send_signal(signal.SIGSTOP)
    time.sleep(PAUSE)
    if name == "controller":
        field.closed()
    process.send_signal(signal.SIGCONT)


def two_simulators(field: Field) -> None:
    """A second plant on the same topics ends by itself."""
    other = field.run("simulator", **OPTIONS["simulator"])
    hold(other.end(None) == 2, f"the second simulator: {other.said[-500:]}")


def turned_parameters(field: Field) -> None:
    """Random physical parameters and gains in their ranges, during motion; each is set or refused with a message."""
    owner = field.random.choice(("simulator", "controller"))
    names = [name for name in field.probe.names(owner) if "." in name and not name.startswith(("qos", "initial"))]
    chosen = field.random.sample(names, min(6, len(names)))
    usual = {}
    for name in chosen:
        description = field.probe.describe(owner, name)
        if description.type != ParameterType.PARAMETER_DOUBLE or not description.floating_point_range:
            continue
        limits = description.floating_point_range[0]
        low, high = max(limits.from_value, -1e9), min(limits.to_value, 1e9)
        value = field.probe.get(owner, name)
        usual[name] = value
        near = field.random.choice((low, high, field.random.uniform(low, high), value * field.random.uniform(0.3, 3.0)))
        done, reason = field.probe.set(owner, **{name.replace(".", "__"): min(max(near, low), high)})
        hold(done or len(reason) > 10, f"{name} was refused without a word")
        time.sleep(0.1)
    for name, value in reversed(usual.items()):  # one at a time: some of them must fit each other
        field.probe.set(owner, **{name.replace(".", "__"): value})
    field.kill(owner, signal.SIGINT)
    field.start(owner)


PROCESSES: dict[str, Callable[[Field], Any]] = {
    "kill -9 of the simulator": kill_simulator,
    "kill -9 of the controller": kill_controller,
    "kill -9 of the recorder": kill_recorder,
    "kill -9 of the identification": kill_identification,
    "SIGINT or SIGTERM, and a restart": end_and_restart,
    "SIGSTOP for 0.7 s": stop_and_continue,
    "two simulators on one topic": two_simulators,
    "parameters turned at random": turned_parameters,
}
