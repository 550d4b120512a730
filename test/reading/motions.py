"""Recordings of one machine for the tests of reading: with two valve-driven chambers, and with one held or vented."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
from identify.making import POSITION_NOISE, PRESSURE_NOISE, recording, voltage

from pneumo_ros.plant import load_model
from pneumo_ros.records import Recording

N, DT = 8000, 1e-3
TIME = np.arange(N) * DT
MODEL = load_model()
STROKES = np.where(np.sin(2.0 * np.pi * 0.5 * TIME) > 0.0, 2.5, -2.5) * (0.6 + 0.4 * np.sin(1.3 * TIME))  # V


@lru_cache(maxsize=1)
def both() -> Recording:
    """Random steps of the default machine."""
    volts = voltage("steps", TIME)
    begin = MODEL.state(p_a=3e5, p_b=3.9e5)
    return measured(np.vstack([begin, MODEL.simulate(volts[:-1], begin)]), volts)


@lru_cache(maxsize=2)
def held(pressure: float, rest: float) -> Recording:
    """A piston with a spring that is slack at `rest` [m]; in chamber b, as large as a hall, `pressure` [Pa] does not
    change. Its friction is a third of the default machine's."""
    values = {
        "chambers.volume_b": 10.0, "lugre_friction.coulomb_friction": 20.0, "lugre_friction.static_friction": 25.0,
        "spring_load.stiffness": 400.0, "spring_load.rest_position": rest,
    }  # fmt: skip
    model = MODEL.with_effects([*MODEL.effects, "spring_load"], values)
    begin = model.state(p_a=2.5e5, p_b=pressure)
    return measured(np.vstack([begin, model.simulate(STROKES[:-1], begin)]), STROKES)


def measured(states: np.ndarray, volts: np.ndarray) -> Recording:
    """States (n, states) with the noise of sensors."""
    random = np.random.default_rng(3)
    y = states[:, 0] + random.normal(0.0, POSITION_NOISE, N)
    p_a, p_b = (states[:, k] + random.normal(0.0, PRESSURE_NOISE, N) for k in (2, 3))
    return recording(
        time=TIME, position=y, pressure_a=p_a, pressure_b=p_b, voltage=volts, command_time=TIME, command=volts
    )


def vented() -> Recording:
    """Chamber b open to the atmosphere."""
    return held(1.01325e5, -0.27)


def regulated() -> Recording:
    """Chamber b at 2.2 bar."""
    return held(2.2e5, -0.19)


def without(whole: Recording, *names: str) -> Recording:
    """A recording without some of its signals; the command is `voltage`."""
    absent = [*names, *(("command", "command_time") if "voltage" in names else ())]
    return replace(whole, **dict.fromkeys(absent))


def sealed() -> Recording:
    """Two sealed chambers that a test machine compresses, recorded without a word about it."""
    y = 0.1 * np.sin(2.0 * np.pi * 0.5 * TIME)
    a, b = (MODEL[f"chambers.volume_{c}"] + s * MODEL[f"piston.area_{c}"] * y for c, s in (("a", 1.0), ("b", -1.0)))
    states = np.zeros((N, 4))
    states[:, 0], states[:, 2], states[:, 3] = y, 4e5 * (a[0] / a) ** 1.3, 5e5 * (b[0] / b) ** 1.3
    return without(measured(states, TIME), "voltage")
