"""Plant and control law in lockstep, in one process: measure, step the law, hold its voltage for a sample, repeat."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.control.law import Law
from pneumo_ros.control.measurement import Measurement
from pneumo_ros.control.setpoint import Reference

Array = NDArray[np.float64]


class SteppedPlant(Protocol):
    """A plant that is stepped sample by sample, such as `pneumo_ros.plant.Stepper`."""

    sample_time: float
    state: Array

    def advance(self, voltage: float) -> Array:
        """Hold `voltage` [V] for one sample; returns the state."""
        ...


Sensor = Callable[[float, Array], Measurement]  # time [s], state (states,) -> what the law reads


@dataclass(frozen=True)
class Record:
    """A run, row k at time[k] [s]: wanted position [m], state (samples, states), voltage [V] held from then on."""

    time: Array
    reference: Array
    states: Array
    voltage: Array


def perfect_sensor(time: float, state: Array) -> Measurement:
    """Position, velocity and pressures as they are; for states that begin with y, v, p_a, p_b."""
    return Measurement(time, float(state[0]), float(state[1]), float(state[2]), float(state[3]))


def closed_loop(
    plant: SteppedPlant, law: Law, reference: Reference, samples: int, sensor: Sensor = perfect_sensor
) -> Record:
    """Run `samples` samples from the plant's present state, time 0.

    Raises the errors of the plant: NumericalError when its state leaves the finite numbers.
    """
    states = np.empty((samples, len(plant.state)))
    times = plant.sample_time * np.arange(samples, dtype=np.float64)
    wanted, voltage = np.empty(samples), np.empty(samples)
    for k in range(samples):
        time = float(times[k])
        states[k] = plant.state
        setpoint = reference(time)
        wanted[k] = setpoint.position
        voltage[k] = law.step(setpoint, sensor(time, plant.state))
        plant.advance(float(voltage[k]))
    return Record(times, wanted, states, voltage)
