"""Sensor signals and log of the true motion."""

from typing import NamedTuple

import numpy as np
from scipy.signal import lfilter

from .loop import SAMPLE, readings
from .machine import Machine

POSITION_NOISE, POSITION_STEP = 5e-6, 1e-5  # m
PRESSURE_NOISE, PRESSURE_RANGE = 300.0, 1e6  # Pa
PRESSURE_STEP = PRESSURE_RANGE / 2**16
CLOCK_JITTER = 10e-6  # s


class Logger(NamedTuple):
    """How the sensors are read: readings per second, which divide 1000 or are a multiple of it, and their noise.

    A slower logger stores every second or fourth reading as it is, without a filter; commands are stored whenever they
    are sent. `noise` multiplies the noise of the sensors and the steps of their readings.
    """

    rate: int = 1000
    noise: float = 1.0

    @property
    def finer(self) -> int:
        """Readings per millisecond."""
        return max(self.rate // 1000, 1)

    @property
    def every(self) -> int:
        """Of that many readings one is stored."""
        return max(1000 // self.rate, 1)


USUAL = Logger()


class Run(NamedTuple):
    """One run as recorded: arrays (n,), and the truth behind it."""

    name: str
    stamps: np.ndarray  # header stamps, ns after the start
    log_times: np.ndarray  # when the logger got the messages, ns
    position: np.ndarray  # m
    pressure_a: np.ndarray  # Pa abs
    pressure_b: np.ndarray
    voltage: np.ndarray  # V held over each millisecond, of another length where sensors are read at another rate
    command_index: np.ndarray  # milliseconds at which the command was sent: at changes, and at least every 100 ms
    truth: np.ndarray  # (n, 5): y, v, p_a, p_b, z at the sampling instants


def position_noise(rng: np.random.Generator, n: int, scale: float = 1.0) -> np.ndarray:
    """Noise of the encoder before it is rounded [m]."""
    return rng.normal(0.0, scale * POSITION_NOISE, n)


def _delayed(m: Machine, truth: np.ndarray, sample: float) -> np.ndarray:
    """Position one sensor delay ago, by the cubic through positions and velocities of neighbouring samples."""
    back = np.arange(len(truth)) - m.position_delay / sample
    left = np.clip(np.floor(back).astype(int), 0, len(truth) - 2)
    s = np.clip(back - left, 0.0, 1.0)
    (y0, v0), (y1, v1) = truth[left, :2].T, truth[left + 1, :2].T
    rise = y1 - y0
    return y0 + s * (rise + (1.0 - s) * ((1.0 - s) * (v0 * sample - rise) - s * (v1 * sample - rise)))


def _filtered(m: Machine, position: np.ndarray, sample: float) -> np.ndarray:
    """Position behind a first-order low-pass, exact for one that goes straight from sample to sample."""
    left = np.exp(-sample / m.position_filter)
    mean = m.position_filter / sample * (1.0 - left)
    part = lfilter([1.0 - mean, mean - left], [1.0, -left], position - position[0])
    return position[0] + part


def _loose(m: Machine, position: np.ndarray) -> np.ndarray:
    """Reading of an encoder that is dragged along through a dead band."""
    shown, follower = np.empty_like(position), position[0]
    for k, y in enumerate(position):
        follower = min(max(follower, y - m.encoder_play), y + m.encoder_play)
        shown[k] = follower
    return shown


def _pressure(rng: np.random.Generator, p: np.ndarray, offset: float, gain: float, noise: float) -> np.ndarray:
    step = noise * PRESSURE_STEP
    volts = (1.0 + gain) * p + offset + rng.normal(0.0, noise * PRESSURE_NOISE, len(p))
    return np.clip(np.round(volts / step), 0, PRESSURE_RANGE // step - 1) * step


def record(
    name: str,
    m: Machine,
    states: np.ndarray,
    voltage: np.ndarray,
    noise: np.ndarray,
    rng: np.random.Generator,
    logger: Logger = USUAL,
) -> Run:
    """The run as it is recorded, of states (n, states) at the readings, and of the voltage held over each millisecond.

    `noise` (n,) [m] is the encoder's, already used by a position loop. The samples are taken on time; only their
    stamps jitter.
    """
    n, truth, sample, kept = len(states), readings(m, states), SAMPLE / logger.finer, slice(None, None, logger.every)
    position = _delayed(m, truth, sample) if m.position_delay > 0.0 else truth[:, 0]
    position = _filtered(m, position, sample) if m.position_filter > 0.0 else position
    position = _loose(m, position) if m.encoder_play > 0.0 else position
    nominal, step = np.arange(n) * round(sample * 1e9), logger.noise * POSITION_STEP
    stamps = nominal + np.round(rng.normal(0.0, CLOCK_JITTER, n) * 1e9).astype(np.int64)
    log_times = nominal + np.round(2e4 + rng.gamma(3.0, 1.7e4, n)).astype(np.int64)
    changed = np.concatenate(([True], np.diff(voltage) != 0.0))
    return Run(
        name=name,
        stamps=stamps[kept],
        log_times=log_times[kept],
        position=(np.round((position + noise) / step) * step)[kept],
        pressure_a=_pressure(rng, truth[:, 2], m.offset_a, m.gain_a, logger.noise)[kept],
        pressure_b=_pressure(rng, truth[:, 3], m.offset_b, m.gain_b, logger.noise)[kept],
        voltage=voltage,
        command_index=np.flatnonzero(changed | (np.arange(len(voltage)) % 100 == 0)),
        truth=truth[kept],
    )
