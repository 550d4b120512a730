"""One recorded machine: the base axis and every effect it may hide, each with a setting that means absent.

SI units, absolute pressures; forces are positive against extension. Fields of an effect have the value that adds
nothing. The dynamics are in `valve`, `gas`, `friction`, `motion`; `effects` says which fields an effect changes.
"""

from typing import NamedTuple

import numpy as np
from scipy.signal import lfilter


class Machine(NamedTuple):
    """Everything that stays constant during a run."""

    mass: float = 5.0
    area_a: float = 4.1e-4
    area_b: float = 3.0e-4
    half_stroke: float = 1.0
    volume_a: float = 5.1e-4
    volume_b: float = 4.0e-4
    supply: float = 7e5
    atmosphere: float = 1e5
    gas_constant: float = 287.0
    temperature: float = 293.0
    adiabatic: float = 1.4

    dead_right: float = 0.78
    dead_left: float = 0.78
    gain: float = 2.0  # of the voltage beyond the dead zone, inside the arc tangent [1/V]
    fill: float = 0.69501e-8
    exhaust: float = 0.898105e-8

    static: float = 100.0
    coulomb: float = 70.0
    stribeck: float = 0.01
    bristle: float = 1.4e6
    bristle_damping: float = 50.0
    elastic_share: float = 0.9
    drag: float = 4546.7
    stop_stiffness: float = 1e6
    stop_damping: float = 1e3

    # friction
    viscous_out: float = 0.0  # extending [N s/m]
    viscous_in: float = 0.0  # retracting
    viscous_power: float = 1.0  # of the speed, equal to linear at 0.3 m/s
    retract_excess: float = 0.0  # share by which friction is higher while retracting ...
    retract_static: float = 1.0  # ... and of that, the share of the part beyond Coulomb friction
    spot_height: float = 0.0  # tight spot: share at its centre
    spot_centre: float = 0.0
    spot_width: float = 0.05  # standard deviation of the bell
    bow: float = 0.0  # bent rod: share gained at 0.5 m from the middle, growing with the square
    seal: float = 0.0  # friction by pressure [N/Pa]
    seal_power: float = 1.0  # how it grows with pressure, equal to linear at 3e5 Pa gauge
    stribeck_power: float = 2.0
    stribeck_rational: float = 0.0  # share that falls as 1 / (1 + (v / v_s)^power), not by an exponential
    warm_share: float = 0.0
    warm_fast: float = 30.0  # time constants of two exponentials [s] ...
    warm_slow: float = 30.0
    warm_split: float = 1.0  # ... and the first one's share
    warm_work: float = 0.0  # share lost once friction has made 20 W for long, first order by warm_fast
    rest_rise: float = 0.0  # increase of static friction after a long rest [N]
    rest_time: float = 1.0
    rest_power: float = 1.0  # stretched exponential
    rest_log: float = 0.0  # 1: grows with the logarithm instead, by rest_rise in 10 s
    rest_slip: float = 1e-4  # sliding distance that forgets the rest [m]
    lag_delay: float = 0.0  # the bristle's highest force answers the velocity of this long ago [s]
    lag_film: float = 0.0  # or a first-order lag of it [s]

    # loads
    payload: float = 0.0
    load: float = 0.0
    spring: float = 0.0
    spring_centre: float = 0.0
    spring_hardening: float = 0.0  # share of its stiffness gained at 0.3 m
    spring_power: float = 2.0  # of the distance in that gain
    load_share: float = 0.0  # share of the mass behind a coupling
    coupling: float = 0.0  # its stiffness [N/m]
    coupling_damping: float = 0.0
    coupling_gap: float = 0.0  # its dead band, half width [m]
    detent: float = 0.0  # periodic force over position [N]
    detent_pitch: float = 0.01
    detent_phase: float = 0.0

    # valve and supply
    null_offset: float = 0.0
    play: float = 0.0  # half width [V]
    play_spread: float = 0.0  # 0: one play; 1: five plays, of half widths from 0 to twice the mean
    spool_rate: float = 0.0  # natural frequency [rad/s]; 0: the spool is where the command is
    spool_damping: float = 0.8
    spool_lag: float = 0.0  # first order [s], instead
    spool_slew: float = 1e9  # ... and no faster than this [V/s]
    sonic: float = 0.0  # share of the flow that goes the ISO 6358 way
    sonic_conductance: float = 5e-9
    critical_ratio: float = 0.3
    subsonic_index: float = 0.5
    sneak: float = 0.0  # flow past the closed spool edges at full supply [kg/s]
    sneak_width: float = 0.6  # opening at which it has fallen to half [V]
    feed: float = 0.0  # resistance of the supply line [Pa s/kg]; 0: stiff supply
    tank: float = 1e-3
    ripple: float = 0.0  # share of the supply pressure
    ripple_hertz: float = 3.0

    # lines and chambers
    line_delay: float = 0.0
    line_lag: float = 0.0  # or a first-order lag: the tube as a small volume [s]
    line_loss: float = 0.0  # R_t R T L / (2 c) of the tube [Pa]: exp(-this / p) of the flow gets through
    cushion: float = 1.0  # share of the exhaust path left at the very end
    cushion_length: float = 0.02
    kink: float = 1.0  # share of hose a left beyond the kink
    kink_position: float = 0.0
    kink_width: float = 0.01
    kink_side: float = 1.0  # +1: kinked above that position, -1: below
    cross: float = 0.0  # leak across the piston: linear [kg/(s Pa)]
    cross_gap: float = 0.0  # ... laminar gap of a gas, difference of squares, same slope at 4e5 Pa mean
    cross_orifice: float = 0.0  # ... turbulent, same flow at 2e5 Pa difference
    leak_a: float = 0.0  # to atmosphere, linear
    leak_b: float = 0.0
    leak_gap_a: float = 0.0  # to atmosphere, laminar gap of a gas, same flow at 4e5 Pa
    leak_gap_b: float = 0.0
    wall_time: float = 0.0  # gas to wall at mid stroke and 4e5 Pa [s]; 0: the base model's constant gas temperature

    # sensors
    offset_a: float = 0.0
    offset_b: float = 0.0
    gain_a: float = 0.0
    gain_b: float = 0.0
    position_delay: float = 0.0
    position_filter: float = 0.0  # first-order low-pass of the encoder's reading [s]
    encoder_play: float = 0.0  # half width [m]


_RECORD = np.dtype([(name, float) for name in Machine._fields])


def packed(machine: Machine) -> np.record:
    """The machine as one record, which numba passes by reference: half the compile time, and faster."""
    return np.array([tuple(machine)], dtype=_RECORD).view(np.recarray)[0]


class Roughness(NamedTuple):
    """Disturbances of no model: a force over time and a friction texture over position."""

    force: np.ndarray  # (n,) N, one value per FORCE_SPACING, linear between
    texture: np.ndarray  # (m,) N, from position -1.2 m, one value per TEXTURE_SPACING, linear between


FORCE_SPACING = 1e-3
TEXTURE_START, TEXTURE_SPACING = -1.2, 1e-4
SMOOTH = Roughness(np.zeros(2), np.zeros(2))


def rough_surface(
    surface: np.random.Generator, weather: np.random.Generator, samples: int, force: float = 0.3, texture: float = 0.5
) -> Roughness:
    """A coloured force of `force` N rms over samples of 1 ms, and a texture of `texture` N rms over the stroke.

    The force is first-order noise with a corner at 5 Hz. The texture is a sum of 200 waves of 3 to 300 mm.
    """
    decay = np.exp(-2.0 * np.pi * 5.0 * FORCE_SPACING)
    kicks = weather.normal(0.0, force * np.sqrt(1.0 - decay**2), samples + 2)
    kicks[0] = weather.normal(0.0, force)
    y = TEXTURE_START + TEXTURE_SPACING * np.arange(24001)
    waves = 2.0 * np.pi / 10.0 ** surface.uniform(-2.5, -0.5, 200)
    phases, heights = surface.uniform(0.0, 2.0 * np.pi, 200), surface.normal(0.0, texture / 10.0, 200)
    return Roughness(lfilter([1.0], [1.0, -decay], kicks), np.sin(np.outer(y, waves) + phases) @ heights)


# Parameters that wear changes by 5 %; those set by a scale, a ruler or a regulator are exact.
WORN = (
    "dead_right",
    "dead_left",
    "gain",
    "fill",
    "exhaust",
    "static",
    "coulomb",
    "stribeck",
    "bristle",
    "bristle_damping",
    "drag",
)


def worn(machine: Machine, rng: np.random.Generator, share: float = 0.05) -> Machine:
    """The machine with each WORN parameter off by up to `share`, uniformly."""
    factors = rng.uniform(1.0 - share, 1.0 + share, len(WORN))
    return machine._replace(**{name: getattr(machine, name) * f for name, f in zip(WORN, factors, strict=True)})
