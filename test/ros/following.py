"""A running simulator, stepped sample by sample along a recording of another one."""

import threading
import time

import numpy as np
from ros.probe import Probe, stamp
from std_srvs.srv import Trigger

from pneumo_ros.records import Recording

LONG = 120.0  # s: the machine may be busy


def follow(twin: Probe, recording: Recording) -> np.ndarray:
    """Distances [m] between the twin and the recording at every sample, while the twin gets the recording's commands
    from the recording's start. The twin is stepped: its clock is the recording's, even on a busy machine.
    """
    assert recording.pressure_a is not None
    assert recording.pressure_b is not None
    assert recording.voltage is not None
    start = {"y": recording.position, "p_a": recording.pressure_a, "p_b": recording.pressure_b}
    values = {f"initial__{name}": float(signal[:50].mean()) for name, signal in start.items()}
    assert twin.set("simulator", command_timeout=0.0, **values) == (True, "")
    assert twin.pause(True).success
    assert twin.trigger("simulator/reset").success
    began, heard = time.time_ns(), twin.heard["joint_states"]
    step, volts = Stepping(twin), 0.0
    for wanted in recording.voltage[:-1].tolist():
        if wanted != volts:
            volts = wanted
            commanded(twin, volts)
        step()
    samples = len(recording) - 1
    stepped = twin.wait(lambda: (new := [one for one in heard if stamp(one) > began])[samples - 1 :] and new, "samples")
    assert twin.pause(False).success
    assert len(stepped) == samples
    return np.abs(np.array([one.position[0] for one in stepped]) - recording.position[1:])


class Stepping:
    """Calls ~/step, one after another."""

    def __init__(self, twin: Probe) -> None:
        self._client = twin.node.create_client(Trigger, "simulator/step")
        assert self._client.wait_for_service(LONG)

    def __call__(self) -> None:
        """One sample."""
        done = threading.Event()
        answer = self._client.call_async(Trigger.Request())
        answer.add_done_callback(lambda _: done.set())
        assert done.wait(LONG)
        assert answer.result().success


def commanded(twin: Probe, volts: float) -> None:
    """Send a command and wait until the twin has it."""
    name = f"{twin.node.get_namespace().strip('/')}/simulator"
    twin.matched(twin.command)
    before = int(twin.health(name)[1]["commands"])
    twin.send(volts)
    twin.wait(lambda: int(twin.health(name)[1]["commands"]) > before, "a command", LONG)
