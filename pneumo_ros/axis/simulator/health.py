"""What the simulator reports on /diagnostics."""

import time

from pneumo_ros.axis.health import Health
from pneumo_ros.axis.simulator.lockstep import Lockstep
from pneumo_ros.axis.simulator.simulation import Simulation
from pneumo_ros.axis.ticker import Ticker


class Monitor:
    """Turns counts into health: rates since the last look, warnings when a count has grown since."""

    def __init__(self, simulation: Simulation, pace: Ticker | Lockstep | None) -> None:
        """`pace` advances the simulation; None where another simulator does."""
        self._simulation, self._pace = simulation, pace
        self._at, self._counts = time.monotonic(), self._read()

    def _read(self) -> dict[str, int]:
        valves, pace = self._simulation.valves, self._pace
        counts = {"samples": self._simulation.total, "commands": sum(valve.accepted for valve in valves)}
        counts |= {
            "rejected_inputs": sum(valve.refused for valve in valves) + self._simulation.force.refused,
            "saturated_inputs": sum(valve.clipped for valve in valves),
            "valve_closures": sum(valve.expired for valve in valves),
        }
        if isinstance(pace, Ticker):
            return counts | {"late_ticks": pace.late, "ticks": pace.ticks, "dropped_ms": pace.dropped_ns // 1_000_000}
        return counts | ({"command_timeouts": pace.timeouts} if pace else {})

    def look(self, paused: bool, fault: str | None, compiling: bool) -> Health:
        """Health since the last look."""
        now, counts = time.monotonic(), self._read()
        grown = {name: counts[name] - self._counts[name] for name in counts}
        factor = grown["samples"] / self._simulation.rate / max(now - self._at, 1e-9)
        self._at, self._counts = now, counts
        valve, clock = self._simulation.valve, self._simulation.time
        values = {"real_time_factor": factor, **counts, "simulated_time_s": clock}
        values |= {"command_age_s": valve.age(clock), "voltage_V": valve.voltage}
        if len(self._simulation.valves) > 1:
            values |= {"voltage_b_V": self._simulation.valve_b.voltage}
        values |= {"external_force_N": self._simulation.load_cell or 0.0}
        health = Health(values, _warnings(grown), [fault] if fault else [])
        health.warnings += ["paused"] * (paused and not fault) + ["compiling a kernel"] * compiling
        if self._pace is None and not grown["samples"] and not paused:
            health.warnings.append("no state of the rod from another simulator (coupled/joint_states)")
        if isinstance(self._pace, Lockstep) and not self._pace.closed:
            health.warnings.append("open loop" if self._pace.started else "waiting for a controller")
        return health


def _warnings(grown: dict[str, int]) -> list[str]:
    said = {
        "rejected_inputs": "commands or forces refused: not finite",
        "saturated_inputs": "commands clipped at max_voltage",
        "valve_closures": "valve closed: no command within command_timeout",
        "dropped_ms": "ms dropped: the machine is too slow",
        "command_timeouts": "measurements without command within lockstep_timeout",
    }
    found = [f"{grown[name]} {sentence}" for name, sentence in said.items() if grown.get(name)]
    late, ticks = grown.get("late_ticks", 0), grown.get("ticks", 0)
    return found + ([f"{late} of {ticks} ticks late"] if late > 0.05 * ticks else [])
