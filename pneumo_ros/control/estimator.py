"""Position, velocity and acceleration from noisy position and pressures."""

import cmath
import math


class StateEstimator:
    """Kalman filter of y, v and f, the specific force that pressures do not show (friction and load), a random walk:

        y' = v,    v' = u + f,    f' = white noise of density q,    u = (A_a p_a - A_b p_b - F_atm) / M

    Its steady gains depend on one number, bandwidth = (q / r)^(1/6) with r the density of the position noise: in
    continuous time the poles are those of a Butterworth filter of third order at that frequency (B. Friedland, Control
    System Design, 1986, sec. 11.5). They are placed at exp(s T), which makes the filter independent of sample times;
    the gains follow from these poles (alpha-beta-gamma filter: P. R. Kalata, The Tracking Index, IEEE Trans. Aerospace
    and Electronic Systems 20, 1984).
    Without pressures u = 0, and f is the acceleration itself.
    """

    def __init__(self, bandwidth: float) -> None:
        """Follow with `bandwidth` [rad/s]; it may be changed at any time."""
        self.bandwidth = bandwidth
        self.reset()

    def reset(self) -> None:
        """Start again at the next sample, at rest."""
        self.position = self.velocity = self.unmeasured = self.known = 0.0
        self._started, self._design = False, (0.0, 0.0)
        self._gains = (1.0, 0.0, 0.0)

    @property
    def acceleration(self) -> float:
        """Present acceleration [m/s2]."""
        return self.known + self.unmeasured

    def update(self, position: float, known: float, dt: float) -> None:
        """Take `position` [m] and u [m/s2], `dt` [s] after the last ones."""
        if not self._started:
            self.reset()
            self.position, self.known, self.unmeasured, self._started = position, known, -known, True
            return
        mean = 0.5 * (known + self.known) + self.unmeasured  # u is taken as linear between samples
        predicted = self.position + (self.velocity + 0.5 * mean * dt) * dt
        alpha, beta, gamma = self._gains_for(dt)
        surprise = position - predicted
        self.position = predicted + alpha * surprise
        self.velocity += mean * dt + beta * surprise
        self.unmeasured += gamma * surprise
        self.known = known

    def _gains_for(self, dt: float) -> tuple[float, float, float]:
        if self._design != (self.bandwidth, dt):
            self._design, self._gains = (self.bandwidth, dt), tracking_gains(self.bandwidth, dt)
        return self._gains


def tracking_gains(bandwidth: float, dt: float) -> tuple[float, float, float]:
    """Gains of position [1], velocity [1/s] and acceleration [1/s2] for Butterworth poles at `bandwidth` [rad/s]."""
    real = math.exp(-bandwidth * dt)
    pair = cmath.exp(bandwidth * dt * complex(-0.5, 0.5 * math.sqrt(3.0)))
    size, twice = abs(pair) ** 2, 2.0 * pair.real
    c2, c1, c0 = -(real + twice), size + real * twice, -real * size  # of the characteristic polynomial
    alpha = 1.0 + c0
    gamma = 2.0 * (c1 + c2 + alpha)
    beta = c2 + 3.0 - alpha - 0.25 * gamma
    return alpha, beta / dt, 0.5 * gamma / (dt * dt)
