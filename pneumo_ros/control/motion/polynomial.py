"""Polynomials between two setpoints: linear, cubic through velocities, quintic through accelerations."""

from pneumo_ros.control.setpoint import Setpoint


class Polynomial:
    """Motion from `begin` to `end` [s] with coefficients of (time - begin), lowest first."""

    def __init__(self, begin: float, end: float, coefficients: tuple[float, ...]) -> None:
        """Up to six coefficients, position in m."""
        self.begin, self.end = begin, end
        self.coefficients = (*coefficients, *(0.0,) * (6 - len(coefficients)))

    def __call__(self, time: float) -> Setpoint:
        """The setpoint at `time` [s], also beyond the ends."""
        t = time - self.begin
        c0, c1, c2, c3, c4, c5 = self.coefficients
        return Setpoint(
            c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5)))),
            c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5))),
            2.0 * c2 + t * (6.0 * c3 + t * (12.0 * c4 + t * 20.0 * c5)),
            6.0 * c3 + t * (24.0 * c4 + t * 60.0 * c5),
        )


def linear(begin: float, end: float, first: float, last: float) -> Polynomial:
    """At constant velocity from `first` to `last` [m]."""
    return Polynomial(begin, end, (first, (last - first) / (end - begin)))


def cubic(begin: float, end: float, first: Setpoint, last: Setpoint) -> Polynomial:
    """Through positions and velocities of both ends (Hermite interpolation)."""
    T, d = end - begin, last.position - first.position
    v0, v1 = first.velocity, last.velocity
    c2 = (3.0 * d - (2.0 * v0 + v1) * T) / T**2
    c3 = (-2.0 * d + (v0 + v1) * T) / T**3
    return Polynomial(begin, end, (first.position, v0, c2, c3))


def quintic(begin: float, end: float, first: Setpoint, last: Setpoint) -> Polynomial:
    """Through positions, velocities and accelerations of both ends (Craig, Introduction to Robotics, Eq. 7.18)."""
    T, d = end - begin, last.position - first.position
    v0, v1, a0, a1 = first.velocity, last.velocity, first.acceleration, last.acceleration
    c3 = (20.0 * d - (8.0 * v1 + 12.0 * v0) * T - (3.0 * a0 - a1) * T**2) / (2.0 * T**3)
    c4 = (-30.0 * d + (14.0 * v1 + 16.0 * v0) * T + (3.0 * a0 - 2.0 * a1) * T**2) / (2.0 * T**4)
    c5 = (12.0 * d - 6.0 * (v1 + v0) * T - (a0 - a1) * T**2) / (2.0 * T**5)
    return Polynomial(begin, end, (first.position, v0, 0.5 * a0, c3, c4, c5))
