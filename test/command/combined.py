"""One small recording of every combination of signals, and what each can be judged by."""

from pathlib import Path

import numpy as np

from pneumo_ros.plant import load_model, save_model
from pneumo_ros.records import write_recording

N, DT = 1600, 2.5e-3
TIME = np.arange(N) * DT
# letters of the signals beside the position; i: read with --imposed
LETTERS = {
    "v": "velocity", "a": "pressure_a", "b": "pressure_b", "s": "supply_pressure", "e": "effort", "l": "load_cell",
    "c": "voltage",
}  # fmt: skip
# combination -> equations that are judged
JUDGED = {
    "a": {"momentum"}, "b": {"momentum"}, "ab": {"momentum"}, "va": {"momentum"}, "vab": {"momentum"},
    "as": {"momentum"}, "abs": {"momentum"}, "al": {"momentum"}, "abl": {"momentum"}, "vabsl": {"momentum"},
    "e": {"momentum"}, "ve": {"momentum"}, "ea": {"momentum"}, "eb": {"momentum"}, "eab": {"momentum"},
    "el": {"momentum"}, "es": {"momentum"}, "eabl": {"momentum"}, "eabls": {"momentum"},
    "ca": {"chamber_a"}, "cb": {"chamber_b"}, "cas": {"chamber_a"}, "cbs": {"chamber_b"}, "cal": {"chamber_a"},
    "cae": {"chamber_a"}, "cvb": {"chamber_b"},
    "cab": {"momentum", "chamber_a", "chamber_b"}, "cabs": {"momentum", "chamber_a", "chamber_b"},
    "cabv": {"momentum", "chamber_a", "chamber_b"}, "cabl": {"momentum", "chamber_a", "chamber_b"},
    "cabe": {"momentum", "chamber_a", "chamber_b"}, "cabvsel": {"momentum", "chamber_a", "chamber_b"},
    "li": {"momentum"}, "vli": {"momentum"}, "ei": {"momentum"}, "eli": {"momentum"},
    "ai": {"chamber_a"}, "bi": {"chamber_b"}, "abi": {"chamber_a", "chamber_b"}, "abli": {"chamber_a", "chamber_b"},
}  # fmt: skip
# combination -> what the refusal says is missing
REFUSED = {
    "": "lacks valve/command or the effort",
    "v": "lacks valve/command or the effort",
    "s": "lacks valve/command or the effort",
    "l": "lacks valve/command or the effort",
    "c": "lacks chamber_a/pressure and chamber_b/pressure",
    "cs": "lacks chamber_a/pressure and chamber_b/pressure",
    "cl": "lacks chamber_a/pressure and chamber_b/pressure",
}


def write_all(folder: Path) -> None:
    """Every combination, and a machine file of sealed chambers."""
    save_model(load_model().with_effects(["imposed_motion"]), folder / "sealed.yaml")
    signals = {False: free(0), True: imposed(0)}
    for name in (*JUDGED, *REFUSED):
        write(folder / f"with_{name}", name, signals["i" in name])


def write(path: Path, name: str, signals: dict[str, np.ndarray]) -> None:
    """The recording of one combination."""
    chosen = {LETTERS[letter]: signals[LETTERS[letter]] for letter in name if letter != "i"}
    write_recording(path, time=TIME, position=signals["position"], **chosen)


def write_held(folder: Path, name: str) -> list[str]:
    """Another motion of the same combination, to be held out; its path."""
    path = folder / f"with_{name}_held"
    if not path.exists():
        write(path, name, imposed(1) if "i" in name else free(1))
    return [str(path)]


def noisy(seed: int, **signals: np.ndarray) -> dict[str, np.ndarray]:
    """Signals with the noise of their sensors."""
    random = np.random.default_rng([seed, 7])
    sizes = {"position": 5e-6, "velocity": 1e-3, "effort": 0.3, "load_cell": 0.3, "voltage": 0.0}
    return {name: one + random.normal(0.0, sizes.get(name, 300.0), N) for name, one in signals.items()}


def free(seed: int) -> dict[str, np.ndarray]:
    """A machine moved by its valve, without a load at the rod."""
    model = load_model()
    volts = np.random.default_rng(seed).choice([-2.0, -1.2, 1.2, 2.0], 20)[(TIME / 0.3).astype(int)]
    begin = model.state(p_a=3e5, p_b=3.9e5)
    x = np.vstack([begin, model.simulate(np.repeat(volts[:-1], 10), begin, sample_time=DT, parts=10)])
    thrust = model["piston.area_a"] * x[:, 2] - model["piston.area_b"] * x[:, 3]
    rod = (model["piston.area_a"] - model["piston.area_b"]) * model["air.atmospheric_pressure"]
    supply = np.full(N, model["air.supply_pressure"])
    return noisy(
        seed, position=x[:, 0], velocity=x[:, 1], pressure_a=x[:, 2], pressure_b=x[:, 3], supply_pressure=supply,
        effort=thrust - rod, load_cell=np.zeros(N), voltage=volts,
    )  # fmt: skip


def imposed(seed: int) -> dict[str, np.ndarray]:
    """The same piston on a test machine, with sealed chambers or without gas: then the cell reads friction."""
    model = load_model()
    phase = 2.0 * np.pi * (1.0 + 0.3 * seed) * TIME
    y, v = 0.05 * np.sin(phase), 0.05 * np.gradient(phase, TIME) * np.cos(phase)
    a, b = (model[f"chambers.volume_{c}"] + s * model[f"piston.area_{c}"] * y for c, s in (("a", 1.0), ("b", -1.0)))
    friction = model["lugre_friction.coulomb_friction"] * np.tanh(v / 2e-3)
    force = friction + model["piston.mass"] * np.gradient(v, TIME)
    return noisy(
        seed, position=y, velocity=v, pressure_a=3e5 * (a[0] / a) ** 1.4, pressure_b=4e5 * (b[0] / b) ** 1.4,
        supply_pressure=np.full(N, 7e5), effort=force, load_cell=force, voltage=np.zeros(N),
    )  # fmt: skip


def arguments(folder: Path, name: str) -> tuple[list[str], list[str]]:
    """The recording of a combination and the options to read it."""
    options = ["--imposed"] if "i" in name else []
    if ("i" in name and not {"l", "e"} & set(name)) or name == "abli":
        options += ["--model", str(folder / "sealed.yaml")]
    return [str(folder / f"with_{name}")], options
