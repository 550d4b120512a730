"""The simulations of several axes on one plant: advanced, reset and stamped as one."""

from pneumo_ros.axis.simulator.shared_plant import SharedPlant
from pneumo_ros.axis.simulator.simulation import Simulation


class Together:
    """What a `Simulation` is for one axis, for the machine; each axis keeps its valve, sensors and initial state."""

    def __init__(self, plant: SharedPlant) -> None:
        """The simulations are added, each made with its part of `plant`, before the first sample."""
        self.plant, self.rate = plant, 1.0 / plant.sample_time
        self.simulations: dict[str, Simulation] = {}

    def add(self, axis: str, simulation: Simulation) -> Simulation:
        """Take the simulation of `axis`; the same is returned."""
        self.simulations[axis] = simulation
        return simulation

    @property
    def time(self) -> float:
        """Simulated time [s] since the start or the last reset of the whole machine."""
        return self.plant.samples * self.plant.sample_time

    @property
    def clock(self) -> int:
        """Simulated time [ns] for stamps, the same for all axes."""
        return next(iter(self.simulations.values())).clock

    def reset(self) -> None:
        """Back to time 0 and a full supply, every axis to its initial state."""
        self.plant.reset()
        for one in self.simulations.values():
            one.reset()

    def advance(self, begin: int, part: float) -> None:
        """One sample of all axes; see `Simulation.advance`."""
        self.plant.advance({axis: one.hold(begin, part) for axis, one in self.simulations.items()})
        for one in self.simulations.values():
            one.sense()
