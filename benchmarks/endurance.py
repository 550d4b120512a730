"""Endurance: a day of simulated time with its balances, and minutes of real time at 1 kHz with every message recorded.

The model: random voltages drive the piston to random places. Over each part the change of the gas in a chamber must
equal the inflow through its port (d(p V) + (gamma - 1) p dV = gamma R T q dt), and the energy of the piston must
change by the work of the pressures less that of friction. Residuals are relative to the amount exchanged; memory must
not grow.

The nodes: simulator, controller and recorder in processes of their own. The memory of each, the stamps in the
recording, of which none may be missing, and the late ticks that the simulator has reported.

    python benchmarks/endurance.py [--hours 24] [--minutes 20] [--seed 1]

The exit code is 1 when a balance is off by more than 0.1 %, memory grew by more than 20 MB, or a message is missing.
"""

import argparse
import resource
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "test")]

PIECE, SAMPLE = 250, 1e-3  # samples of s between two choices of a voltage
PARTS = 6  # rows of each table
OFF, GROWN = 1e-3, 20.0  # share of a balance; MB


def arguments() -> argparse.Namespace:
    """The options."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hours", type=float, default=24.0, help="simulated (default 24; 0: none)")
    parser.add_argument("--minutes", type=float, default=20.0, help="of real time (default 20; 0: none)")
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


class Balances:
    """Sums of what enters, leaves and remains, over a part of the time."""

    def __init__(self, model: Any) -> None:
        self.model = model
        self.off, self.through = np.zeros(3), np.zeros(3)  # chamber a, chamber b [J], piston [J]

    def add(self, x: np.ndarray, seen: dict[str, np.ndarray]) -> None:
        """A piece of states (n, nx) and outputs at its samples; the first sample ended the previous piece."""
        model, y, v = self.model, x[:, 0], x[:, 1]
        gamma, heat = model["air.heat_capacity_ratio"], model["air.gas_constant"] * model["air.temperature"]
        for k, (side, sign) in enumerate((("a", 1.0), ("b", -1.0))):
            volume = model[f"chambers.volume_{side}"] + sign * model[f"piston.area_{side}"] * y
            p, flow = x[:, 2 + k], gamma * heat * seen[f"port_flow_{side}"]
            done = (gamma - 1.0) * _over(p, np.diff(volume))
            came = _over(flow, np.full(len(y) - 1, SAMPLE))
            self.off[k] += (p * volume)[-1] - (p * volume)[0] + done - came
            self.through[k] += _over(np.abs(flow), np.full(len(y) - 1, SAMPLE))
        work, taken = (_over(seen[name] * v, np.full(len(y) - 1, SAMPLE)) for name in ("effort", "friction"))
        self.off[2] += 0.5 * model["piston.mass"] * (v[-1] ** 2 - v[0] ** 2) - work + taken
        self.through[2] += _over(np.abs(seen["effort"] * v), np.full(len(y) - 1, SAMPLE))

    def shares(self) -> np.ndarray:
        """Residuals relative to the amount exchanged (3,)."""
        return np.abs(self.off) / np.maximum(self.through, 1e-300)


def _over(values: np.ndarray, widths: np.ndarray) -> float:
    """Trapezoidal sum."""
    return float(np.sum(0.5 * (values[1:] + values[:-1]) * widths))


def memory(pid: int | str = "self") -> float:
    """Memory of a process [MB]."""
    return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * resource.getpagesize() / 1e6


def simulated(hours: float, seed: int) -> bool:
    """The table of the model; whether all checks passed."""
    from pneumo_ros.plant import load_model

    model, random = load_model("axis"), np.random.default_rng(seed)
    state, first, good, begun = model.state(), 0.0, True, time.monotonic()
    print(f"\n{hours:g} h simulated, seed {seed}; residuals in parts per million")
    print("  until h  chamber a  chamber b     piston  farthest m  memory MB")
    for part in range(PARTS):
        sums, reach = Balances(model), 0.0
        for _ in range(round(hours * 3600.0 / PARTS / PIECE / SAMPLE)):
            side = 1.0 if random.uniform(-0.8, 0.8) > state[0] else -1.0
            voltage = np.full(PIECE, side * random.uniform(0.0, 2.5))
            x = np.vstack([state, model.simulate(voltage, state)])
            sums.add(x, model.outputs(x, voltage[0]))
            state, reach = x[-1], max(reach, float(np.abs(x[:, 0]).max()))
        first = first or memory()
        shares, held = sums.shares(), memory()
        good &= bool((shares < OFF).all()) and held - first < GROWN and bool(np.isfinite(state).all())
        cells = "  ".join(f"{1e6 * share:9.3f}" for share in shares)
        print(f"{hours * (part + 1) / PARTS:9.1f}  {cells}  {reach:10.3f}  {held:9.0f}", flush=True)
    print(f"{hours * 3600.0 / (time.monotonic() - begun):.0f} times real time")
    return good


def recorded(minutes: float) -> bool:
    """The table of the nodes; whether all checks passed."""
    import conftest  # a ROS domain of its own, before anything imports rclpy
    from ros.processes import node, running
    from ros.processes import recorded as on_disk

    from pneumo_ros.records import read_topics

    with tempfile.TemporaryDirectory(prefix="pneumo_ros_endurance_") as folder, ExitStack() as stack:
        bag = Path(folder) / "bag"
        commands = {
            "recorder": node("recorder", output=bag),
            "simulator": node("simulator", publish_rate=1000.0),
            "controller": node("controller", **{"reference.shape": "sine", "reference.frequency": 0.2}),
        }
        nodes = {name: stack.enter_context(running(*words, cwd=Path(folder))) for name, words in commands.items()}
        while not on_disk(bag, "/valve/command"):
            time.sleep(0.5)
        time.sleep(5.0)
        first = {name: memory(one.process.pid) for name, one in nodes.items()}
        print(f"\n{minutes:g} min at 1 kHz, ROS domain {conftest.DOMAIN.number}")
        print(f"  until min  {'  '.join(f'{name} MB' for name in nodes)}")
        held = first
        for part in range(PARTS):
            time.sleep(60.0 * minutes / PARTS)
            held = {name: memory(one.process.pid) for name, one in nodes.items()}
            cells = "  ".join(f"{value:{len(name) + 3}.0f}" for name, value in held.items())
            print(f"{minutes * (part + 1) / PARTS:11.1f}  {cells}", flush=True)
        codes = [nodes[name].end() for name in ("controller", "simulator", "recorder")]
        closing = next(line for _, line in nodes["recorder"].lines if "recorded" in line)
        topics = read_topics(bag, ["/joint_states", "/diagnostics"])
        stamps = topics["/joint_states"].stamp
        missing = int(np.sum(np.diff(stamps) // 1_000_000 - 1))
        print(f"{len(stamps)} joint states recorded, {missing} missing between them; exit codes {codes}")
        print(f"late ticks in sixths of the time: {late(topics['/diagnostics'])}")
        print(closing.partition("recorder]: ")[2].replace(f"{bag}", "the bag"))
        grown = max(held[name] - first[name] for name in nodes)
        return missing == 0 and grown < GROWN and codes == [0, 0, 0] and "nothing lost" in closing


def late(diagnostics: Any) -> str:
    """Late ticks and all ticks of the simulator in each part of the recording."""
    said = [one for array in diagnostics["status"] for one in array if one.name == "simulator"]
    counts = np.array([[int({v.key: v.value for v in one.values}[key]) for key in ("late_ticks", "ticks")]
                       for one in said])  # fmt: skip
    parts = counts[np.linspace(0, len(counts) - 1, PARTS + 1).astype(int)]
    return ", ".join(f"{a} of {b}" for a, b in np.diff(parts, axis=0).tolist())


def main() -> int:
    """Run both, print; 1 if a check failed."""
    options = arguments()
    good = [simulated(options.hours, options.seed)] if options.hours else []
    good += [recorded(options.minutes)] if options.minutes else []
    return int(not all(good))


if __name__ == "__main__":
    sys.exit(main())
