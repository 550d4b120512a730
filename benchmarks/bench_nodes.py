"""The nodes against the clock: real-time factor, late ticks, processor time and answers at 1 kHz; lockstep.

Every row is a run of real processes in a ROS domain of their own (except the last, which runs without ROS). Processor
time is that of the whole process, all threads, as a share of one core. A tick is late when it begins more than 1 ms
after its deadline. An answer lasts from the sending of a joint state to the arrival of its valve command: both ways
through the middleware plus the control step, so longer than a command needs to reach the plant. Lockstep runs the
default machine under PID control along a sine.

    python benchmarks/bench_nodes.py [--seconds 60] [--answer-seconds 20] [--lockstep-seconds 10] [--rate 1000]
"""

import argparse
import os
import sys
import time
from typing import Any

from answering import answers
from processes import REFERENCE, cpu_seconds, nodes

from pneumo_ros.control import Measurement, Pid, closed_loop
from pneumo_ros.control.reference import sine
from pneumo_ros.environment import Domain
from pneumo_ros.plant import Stepper, load_model

START = 6.0  # s for processes to find each other and settle, from the simulator's first report on
BOUND = 120.0  # s until that one; a busy machine is slow to start processes
LOCKSTEP = ("-p", "real_time_factor:=0.0")


class Listener:
    """Collects the simulator's /diagnostics: wall time of the message [s], numbers by name."""

    def __init__(self) -> None:
        # in the ROS domain that the environment names by now
        import rclpy
        from diagnostic_msgs.msg import DiagnosticArray
        from rclpy.executors import SingleThreadedExecutor

        rclpy.init()
        self.node = rclpy.create_node("benchmark")
        self.node.create_subscription(DiagnosticArray, "/diagnostics", self._take, 10)
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.heard: list[tuple[float, dict[str, float]]] = []

    def _take(self, message: Any) -> None:
        for status in message.status:
            if status.name == "simulator":
                stamp = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
                self.heard.append((stamp, {pair.key: float(pair.value) for pair in status.values}))

    def listen(self, seconds: float) -> list[tuple[float, dict[str, float]]]:
        """The messages of the next `seconds`."""
        self.heard = []
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.executor.spin_once(timeout_sec=left)
        return self.heard

    def settle(self) -> None:
        """Until all processes have started, found each other and settled."""
        end = time.monotonic() + BOUND
        while not self.listen(0.5) and time.monotonic() < end:
            pass
        self.listen(START)


def real_time(listener: Listener, seconds: float, rate: float) -> None:
    """Print the rows of real-time runs."""
    plant = ("simulator", "-p", f"publish_rate:={rate}")
    print(f"Real time, {seconds:g} s at {rate:g} Hz\n")
    print(f"{'':34} {'real-time factor':>17} {'late ticks':>11} {'simulator':>10} {'controller':>11}")
    for title, commands in (
        ("simulator alone", [plant]),
        ("simulator and controller", [plant, ("controller", *REFERENCE)]),
    ):
        with nodes(*commands) as pids:
            listener.settle()
            before = [cpu_seconds(pid) for pid in pids]
            begin = time.monotonic()
            heard = listener.listen(seconds)
            passed = time.monotonic() - begin
            shares = [(cpu_seconds(pid) - b) / passed for pid, b in zip(pids, before, strict=True)]
        (t0, first), (t1, last) = heard[0], heard[-1]
        factor = (last["samples"] - first["samples"]) / rate / (t1 - t0)
        late = (last["late_ticks"] - first["late_ticks"]) / (last["ticks"] - first["ticks"])
        columns = "".join(f"{share:>11.1%}" for share in shares)
        print(f"{title:34} {factor:17.5f} {late:11.3%}{columns}", flush=True)


def lockstep(listener: Listener, seconds: float, rate: float) -> None:
    """Print the rows of lockstep runs."""
    paced = (*LOCKSTEP, "-p", f"publish_rate:={rate}")
    alone = ("controller", *REFERENCE, "-p", "use_sim_time:=true")
    print(f"\nLockstep at {rate:g} Hz of simulated time\n")
    print(f"{'':34} {'x real time':>17} {'us per sample':>15}")
    for title, commands in (
        ("two processes", [("simulator", *paced), alone]),
        ("one process (axis)", [("axis", *paced, *REFERENCE)]),
    ):
        with nodes(*commands):
            listener.settle()
            heard = listener.listen(seconds)
        (t0, first), (t1, last) = heard[0], heard[-1]
        row(title, (t1 - t0) / (last["samples"] - first["samples"]), rate)
    row("closed_loop, no ROS", without_ros(rate), rate)


def row(title: str, per_sample: float, rate: float) -> None:
    """Print one row of the lockstep table."""
    print(f"{title:34} {1.0 / rate / per_sample:17.1f} {per_sample * 1e6:15.1f}", flush=True)


def without_ros(rate: float, samples: int = 50_000) -> float:
    """Time per sample [s] of the same loop in plain Python."""
    model = load_model("axis")
    plant = Stepper(model, model.state(), sample_time=1.0 / rate)
    begin = time.perf_counter()
    closed_loop(plant, Pid(), sine(0.3, 0.05), samples, lambda t, x: Measurement(t, float(x[0]), float(x[1])))
    return (time.perf_counter() - begin) / samples


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0, help="length of each real-time run")
    parser.add_argument("--lockstep-seconds", type=float, default=10.0, help="wall time of each lockstep run")
    parser.add_argument("--answer-seconds", type=float, default=20.0, help="length of each run of answers")
    parser.add_argument("--rate", type=float, default=1000.0, help="publish rate [Hz] of the real-time runs")
    given = parser.parse_args()
    domain = Domain()
    os.environ.update(domain.environment)
    listener = Listener()
    real_time(listener, given.seconds, given.rate)
    answers(given.answer_seconds, given.rate)
    for rate in (500.0, 1000.0):
        lockstep(listener, given.lockstep_seconds, rate)
    load = os.getloadavg()
    print(f"\n{os.cpu_count()} cores, load average {load[0]:.1f}, Python {sys.version.split()[0]}")


if __name__ == "__main__":
    main()
