"""Velocity from measured positions."""

import math


class VelocityEstimator:
    """Critically damped g-h filter: follows position and velocity of noisy samples, at any spacing in time.

    With theta = exp(-bandwidth dt): g = 1 - theta^2, h = (1 - theta)^2. Source: E. Brookner, Tracking and Kalman
    Filtering Made Easy (1998), sec. 1.2.6 (fading-memory polynomial filter of degree 1). A constant velocity is
    estimated without error, a constant acceleration a with the lag 2 a / bandwidth.
    """

    def __init__(self, bandwidth: float) -> None:
        """Follow with `bandwidth` [rad/s]; it may be changed at any time."""
        self.bandwidth = bandwidth
        self.reset()

    def reset(self) -> None:
        """Start again at the next sample, at rest."""
        self._time, self.position, self.velocity = -math.inf, 0.0, 0.0

    def update(self, time: float, position: float) -> float:
        """Take `position` [m] at `time` [s]; returns the velocity [m/s]. A sample that is not newer changes nothing."""
        dt = time - self._time
        if dt <= 0.0:
            return self.velocity
        if math.isinf(dt):
            self._time, self.position, self.velocity = time, position, 0.0
            return 0.0
        theta = math.exp(-self.bandwidth * dt)
        predicted = self.position + self.velocity * dt
        surprise = position - predicted
        self._time, self.position = time, predicted + (1.0 - theta * theta) * surprise
        self.velocity += (1.0 - theta) ** 2 / dt * surprise
        return self.velocity

    def noise_gain(self, sample_time: float) -> float:
        """Standard deviation of velocity [m/s] over that of white position noise [m] (Brookner, 1.2.6)."""
        theta = math.exp(-self.bandwidth * sample_time)
        return float(math.sqrt(2.0) * ((1.0 - theta) / (1.0 + theta)) ** 1.5 / sample_time)
