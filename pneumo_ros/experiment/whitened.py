"""How far a model's equations are from a record, in deviations of sensor noise.

Nothing is predicted over long times: every equation is evaluated along the measured motion. Its residual is divided by
the effect of noise on it (generalised least squares; Aitken 1936), in short pieces with a free start each.

    momentum     M (y_k+1 - 2 y_k + y_k-1) / h^2 - M a_model    while the piston slides, pieces of 0.1 s
    chambers     p_k - p_0 - int p'_model, less its mean         pieces of 0.5 s
    breakaways   M a_model with the bristle at its limit         at the sample before the piston slips
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.equations.breakaway import UNSEEN, force_spread
from pneumo_ros.experiment.record import INTERVAL, Mask, Record
from pneumo_ros.plant import Model
from pneumo_ros.plant.compose import SENSED
from pneumo_ros.plant.reach import written_by

Array = NDArray[np.float64]


def families(model: Model) -> tuple[str, ...]:
    """What is judged of a machine, in the order of `Whitened.residuals`."""
    pressures = (f"pressure in chamber {chamber.side}" for chamber in model.chambers)
    return ("momentum while sliding", *pressures, "force at breakaway")


NOISE_RATE = 1000.0  # Hz, sample rate for which noise is given
_STEP = 2e-3  # s, of the integration along the motion
_SLIDE_SAMPLES, _HOLD_SAMPLES = 25, 125  # samples: 0.1 s of sliding, 0.5 s of chamber pressure
_TINY = 1e-9  # m/s, velocity of a piston about to slip


@dataclass(frozen=True)
class Noise:
    """White noise of each sample of a 1 kHz recording, standard deviations: position [m], pressures [Pa]."""

    position: float = 10e-6
    pressure: float = 300.0

    @property
    def scaled(self) -> tuple[float, float]:
        """The same noise density, at the sample interval of a record."""
        share = 1.0 / np.sqrt(NOISE_RATE * INTERVAL)
        return float(self.position * share), float(self.pressure * share)


class Whitened:
    """The whitened residuals of models along one record; all models are whitened by the noise of `about`."""

    def __init__(self, record: Record, about: Model, noise: Noise) -> None:
        self.record = record
        self._mass = about["piston.mass"]
        self._noise = noise.scaled
        pieces = _pieces(record.sliding, _SLIDE_SAMPLES + 2)
        self._slides = np.zeros((0, _SLIDE_SAMPLES + 2), dtype=np.int64) if record.part.blocked else pieces
        self._holds = _pieces(record.recorded, _HOLD_SAMPLES)
        self._events = slice(0, 0) if record.part.blocked or "z" not in about.states else slice(None)
        machine = record.part.machine(about)
        self._whitener = self._whiten_sliding(machine)
        self._scatter = self._scatter_of_breakaways(machine)

    def residuals(self, model: Model) -> list[Array]:
        """One array per family (`families`), in noise deviations, within +-1e6; NaN counts as 1e6."""
        with np.errstate(all="ignore"):
            found = self._residuals(self.record.part.machine(model))
        return [np.clip(np.nan_to_num(part, nan=1e6), -1e6, 1e6) for part in found]

    def _residuals(self, machine: Model) -> list[Array]:
        frame, states, claimed = self._along(machine)
        acceleration = 0.5 * (claimed[1:-1, 1] + claimed[2:, 1])
        force = np.zeros(len(frame))
        force[1:-1] = self._mass * (np.diff(frame[:, 0], 2) / INTERVAL**2 - acceleration)
        found = [np.einsum("sij,sj->si", self._whitener, force[self._slides[:, 1:-1]]).ravel()]
        for column in range(2, machine.frame):
            left = np.cumsum(np.diff(frame[:, column], prepend=frame[0, column]) - INTERVAL * claimed[:, column])
            pieces = left[self._holds]
            found.append(((pieces - pieces.mean(axis=1, keepdims=True)) / self._noise[1]).ravel())
        found.append(self._breakaways(machine, states) / self._scatter)
        return found

    def _along(self, model: Model) -> tuple[Array, Array, Array]:
        """Frame without the model's sensor effects, states and mean derivatives: (n, frame), (n, states), (n, states).

        Errors and delays of sensors are subtracted from the signals to first order.
        """
        frame = self.record.frame
        states, claimed = self._follow(model, frame)
        if not _alters_signals(model):
            return frame, states, claimed
        seen = model.outputs(states, self.record.voltage)
        meant = frame.copy()
        for reading, state in SENSED.items():
            if state in model.states:
                column = model.states.index(state)
                meant[:, column] -= seen[reading] - states[:, column]
        meant[:, 1] = np.gradient(meant[:, 0], INTERVAL)
        return meant, *self._follow(model, meant)

    def _follow(self, model: Model, frame: Array) -> tuple[Array, Array]:
        rest = model.state()[frame.shape[1] :]
        return model.follow(frame, self.record.voltage[:-1], rest, sample_time=INTERVAL, step=_STEP)

    def _breakaways(self, model: Model, states: Array) -> Array:
        """Net force [N] on the piston at each breakaway, with friction at its limit; 0 if the model is right."""
        at, ways = self.record.breakaways[self._events], self.record.ways[self._events]
        if not len(at):
            return np.zeros(0)
        held, time = self.record.voltage[at], self.record.time[at]
        limit = states[at].copy()
        v, z = model.states.index("v"), model.states.index("z")
        limit[:, v] = _TINY * ways
        beyond = 1e4 * model["lugre_friction.static_friction"] / model["lugre_friction.bristle_stiffness"]
        limit[:, z] = beyond * ways
        slowed = limit[:, v] - model.derivatives(limit, held, time)[:, z]  # v sigma_0 |z| / g: gives the present g
        limit[:, z] *= limit[:, v] / slowed
        return np.asarray(self._mass * model.derivatives(limit, held, time)[:, v])

    def _whiten_sliding(self, model: Model) -> Array:
        """Inverse roots (pieces, samples, samples) of the covariance that noise gives the force in each piece.

        Position noise enters by its second difference and, times the slope of friction over velocity, by its first;
        pressure noise enters by the piston areas.
        """
        rows, width = _SLIDE_SAMPLES, _SLIDE_SAMPLES + 2
        eye = [np.eye(rows, width, k) for k in range(3)]
        second = self._mass * (eye[0] - 2.0 * eye[1] + eye[2]) / INTERVAL**2
        first = (eye[2] - eye[0]) / (2.0 * INTERVAL)
        slope = self._slope(model)[self._slides].mean(axis=1) if len(self._slides) else np.zeros(0)
        by_position = self._noise[0] * (second + slope[:, None, None] * first)
        by_pressure = self._noise[1] ** 2 * sum(model[chamber.area] ** 2 for chamber in model.chambers)
        covariance = by_position @ np.swapaxes(by_position, 1, 2) + by_pressure * np.eye(rows)
        return np.linalg.inv(np.linalg.cholesky(covariance))

    def _slope(self, model: Model) -> Array:
        """Slope of the force that opposes motion over velocity [N s/m], along the record (n,)."""
        states, _ = self._follow(model, self.record.frame)
        faster = states.copy()
        faster[:, 1] += 1e-3
        held, time = self.record.voltage, self.record.time
        change = model.derivatives(faster, held, time)[:, 1] - model.derivatives(states, held, time)[:, 1]
        return np.asarray(-self._mass * change / 1e-3)

    def _scatter_of_breakaways(self, model: Model) -> Array:
        at = self.record.breakaways[self._events]
        areas = [chamber.way * model[chamber.area] for chamber in model.chambers]
        drive = self.record.frame[:, 2:] @ np.array(areas)
        before = np.maximum(at - round(UNSEEN / INTERVAL), 0)
        return np.asarray(force_spread((drive[at] - drive[before]) / UNSEEN))


def _alters_signals(model: Model) -> bool:
    """Whether sensors of the model show something else than the states."""
    return any(not written_by(effect).isdisjoint(SENSED) for effect in model.composition.effects)


def _pieces(wanted: Mask, length: int) -> NDArray[np.int64]:
    """Indices (pieces, length) of adjacent complete pieces in which every sample is wanted."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], wanted, [False]]).astype(np.int8)))
    begins = [np.arange(a, b - length + 1, length) for a, b in edges.reshape(-1, 2)]
    first = np.concatenate(begins) if begins else np.zeros(0, dtype=np.int64)
    return np.asarray(first[:, None] + np.arange(length))
