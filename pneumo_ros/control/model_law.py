"""Common part of the laws that use the machine: estimates of motion and force, and rest at the target."""

import math
from abc import abstractmethod
from typing import NamedTuple

from pneumo_ros.control.arm import Terms
from pneumo_ros.control.estimator import StateEstimator
from pneumo_ros.control.friction import FrictionObserver
from pneumo_ros.control.gain import Gain
from pneumo_ros.control.law import Law
from pneumo_ros.control.measurement import Measurement
from pneumo_ros.control.pneumatics import Chambers, chambers
from pneumo_ros.control.setpoint import Setpoint
from pneumo_ros.control.spool import SpoolLead
from pneumo_ros.control.stops import Stops

REOPEN = 1.5  # times the tolerance
REST = 0.02  # s without motion after which the piston counts as resting


class AxisState(NamedTuple):
    """The axis as estimated: position [m], velocity [m/s], acceleration [m/s2], its chambers, what the rod moves."""

    position: float
    velocity: float
    acceleration: float
    air: Chambers
    moved: Terms


class ModelLaw(Law):
    """A law that inverts the machine. Without pressures, or if they are not finite, it closes the valve.

    Once the piston rests within `tolerance` of its target, the valve stays closed until the error exceeds 1.5 times
    that: moving a piston that sticks would end in another slip. After some stops at wrong places each further stop
    doubles the tolerance, until the setpoint moves on: no law hunts for ever.
    """

    reads_pressures = inverts_flow = True
    bandwidth = Gain(300.0, "rad/s", "of the estimate of velocity and acceleration", 10.0, 3000.0)
    tolerance = Gain(2e-4, "m", "error that is accepted at rest", 0.0, 0.1)
    rest_span = Gain(5e-5, "m", "motion that is ignored: noise, and bristles that ring", 0.0, 0.01)

    def forget(self) -> None:
        """Forget the estimates."""
        self.estimator, self.friction = StateEstimator(self.bandwidth), FrictionObserver(self.machine)
        self.resting, self.stops, self._spool = False, Stops(), SpoolLead()

    def respond(self, setpoint: Setpoint, measurement: Measurement, dt: float) -> float:
        """Voltage [V]; see `Law.respond`."""
        p_a, p_b = measurement.pressure_a, measurement.pressure_b
        if p_a is None or p_b is None or not math.isfinite(p_a + p_b):
            return 0.0
        state = self._estimate(measurement, p_a, p_b, dt)
        self.friction.machine = self.machine
        self.stops.watch(setpoint.position, state.position, self.rest_span, self.resting, dt)
        self.resting = self._may_rest(setpoint, state)
        if self.resting:
            self.pause(state)
        wanted = 0.0 if self.resting else self.valve.voltage(self.valve.clip(self.opening(setpoint, state, dt)))
        return self._spool.voltage(self.machine, wanted, self.valve.max_voltage, dt)

    @abstractmethod
    def opening(self, setpoint: Setpoint, state: AxisState, dt: float) -> float:
        """Opening [V] of the valve."""

    @abstractmethod
    def pause(self, state: AxisState) -> None:
        """The valve stays closed for a sample, because the piston rests at its target."""

    def _estimate(self, measurement: Measurement, p_a: float, p_b: float, dt: float) -> AxisState:
        air = chambers(self.machine, measurement.position, p_a, p_b)
        seen, machine = self.estimator, self.machine
        seen.bandwidth = self.bandwidth
        seen.update(measurement.position, air.force / machine.terms(measurement.position, seen.velocity).mass, dt)
        velocity = seen.velocity if measurement.velocity is None else measurement.velocity
        return AxisState(seen.position, velocity, seen.acceleration, air, machine.terms(seen.position, velocity))

    def _may_rest(self, setpoint: Setpoint, state: AxisState) -> bool:
        error = abs(setpoint.position - state.position)
        if setpoint.velocity != 0.0:
            return False
        if self.resting:
            return error <= REOPEN * self.patience
        return error <= self.patience and self.stops.still >= REST

    @property
    def patience(self) -> float:
        """The tolerance [m], widened by stops at wrong places."""
        return self.tolerance * self.stops.patience
