"""Requirements on a physical effect, as functions that raise: for every effect of the catalogue, or any other."""

import math

import numpy as np
from plant.catalogue import argument, drawn, effect_function, in_python, meaning, seeded
from plant.units import Quantity, quantity, unit, with_units

from pneumo_ros.plant import Effect, Model
from pneumo_ros.plant.library import FRAME
from pneumo_ros.plant.signals import SIGNALS
from pneumo_ros.units import LINE, unit_along

CYCLES = ((0.0, 1e-5, 20.0), (0.5, 2e-3, 5.0), (0.9, 0.15, 2.0))  # centre [m], amplitude [m], frequency [Hz]


def functions(effect: type[Effect]) -> list[str]:
    """The functions of an effect that a kernel runs."""
    return [key for key in ("equations", "outputs", "advance") if key in effect.functions]


def check_documentation(effect: type[Effect]) -> None:
    """The effect states its meaning, its source, how to recognise it, and the permitted values."""
    assert len((effect.__doc__ or "").split()) >= 4, "say in the docstring what it is and give the equation"
    assert effect.source, "name the source of the equation"
    assert effect.signature or effect.name in FRAME, "say in `signature` how a person recognises it in a recording"
    shipped = effect.__module__.startswith("pneumo_ros.plant.effects.") and effect.name not in FRAME
    assert effect.remedy or not shipped, "say in `remedy` what to do at the machine when it is found"
    for key, parameter in effect.parameters.items():
        assert unit(parameter.unit), key
        assert len(parameter.meaning.split()) >= 2, f"{key}: say what it means"
        assert math.isfinite(parameter.low), f"{key}: give the lowest value that makes sense"
        assert math.isfinite(parameter.high), f"{key}: give the highest value that makes sense"
        assert parameter.low < parameter.high, key
    for key, state in effect.states.items():
        assert unit(state.unit), key
        assert state.meaning, key


def declared_unit(name: str, effect: type[Effect], coordinate: str = LINE) -> Quantity:
    """Unit of what an effect returns under that name, in a machine of that coordinate."""
    kind, _, state = name.partition("_")
    if kind in ("der", "rate") and state in effect.states:
        return (unit(unit_along(effect.states[state].unit, coordinate)) if kind == "der" else unit("1")) / unit("s")
    return unit(unit_along(effect.states[name].unit if name in effect.states else SIGNALS[name].unit, coordinate))


def check_units(effect: type[Effect], coordinate: str = LINE) -> None:
    """Run the effect's functions on quantities: added or compared units match, the results are as declared.

    In a machine of that coordinate: along a line in m and N, or turning in rad and N m.
    """

    def given(name: str) -> Quantity:
        return unit(unit_along(meaning(name, effect)[0], coordinate)) * argument(name, effect, random)

    random = seeded(effect.name)
    for key in functions(effect):
        function, aware, seen = effect.functions[key], with_units(vars(effect)[key]), set()
        for _ in range(60):
            returned = aware(*map(given, function.reads))
            values = returned if isinstance(returned, tuple) else (returned,)
            for name, value in zip(function.writes, map(quantity, values), strict=True):
                declared = declared_unit(name, effect, coordinate)
                assert value.fits(declared), f"{name} comes out as {value}, it is declared as {declared}"
                seen |= {name} if value.value else set()
        assert seen == set(function.writes), f"always zero: {set(function.writes) - seen}"


def check_equations_are_finite(effect: type[Effect]) -> None:
    """Each function alone, over the whole range of its inputs."""
    random = seeded(effect.name)
    for key in functions(effect):
        for _ in range(300):
            given = {a: argument(a, effect, random) for a in effect.functions[key].reads}
            assert np.all(np.isfinite(effect_function(effect, key)(**given))), given


def own_values(effect: type[Effect], random: np.random.Generator) -> dict[str, float]:
    """Random values for the effect's own parameters."""
    return {f"{effect.name}.{key}": drawn(parameter, random) for key, parameter in effect.parameters.items()}


def check_machine_is_finite(model: Model, effect: type[Effect]) -> None:
    """All derivatives of the machine, in random states, for any permitted parameters of the effect."""
    random = seeded(effect.name)
    for _ in range(20):
        own = own_values(effect, random)
        varied = in_python(model.with_parameters(own))
        x = varied.state(y=random.uniform(-1.0, 1.0), v=random.uniform(-3.0, 3.0))
        x[2 : varied.frame] = random.uniform(5e4, 7e5, varied.frame - 2)
        assert np.isfinite(varied.derivatives(x, random.uniform(-10.0, 10.0), random.uniform(0.0, 100.0))).all(), own


def cycle_work(model: Model, centre: float, amplitude: float, frequency: float) -> tuple[float, float]:
    """Work of friction and load force over the last of three cycles of a sine, and the work without signs [J]."""
    count = 200
    t = np.arange(3 * count + 1) / (count * frequency)
    omega, sample, held = 2.0 * np.pi * frequency, 1.0 / (count * frequency), np.full_like(t, 4e5)
    v = amplitude * omega * np.cos(omega * t)
    measured = np.column_stack([centre + amplitude * np.sin(omega * t), v, held, held])
    x, _ = model.follow(measured, np.zeros_like(t), model.state()[4:], sample_time=sample, step=5e-5)
    seen = model.outputs(x, np.zeros_like(t), start=-sample, sample_time=sample)
    power = ((seen["friction"] + seen["force"]) * v)[-count - 1 :]
    mean = 0.5 * (power[1:] + power[:-1]) * sample
    return float(mean.sum()), float(np.abs(mean).sum())


def check_dissipation(model: Model, effect: type[Effect]) -> None:
    """A closed cycle takes energy, or at least gives none, for several motions and parameters without a caution."""
    random = seeded(effect.name)
    for cycle in CYCLES:
        for values in ({}, own_values(effect, random), own_values(effect, random)):
            varied = model.with_parameters(values)
            if not varied.cautions():
                work, size = cycle_work(varied, *cycle)
                assert work >= -1e-2 * size, f"{work} of {size} J over centre, amplitude, frequency {cycle}: {values}"


def mass_rates(model: Model, p_a: float, p_b: float, supply: float, atmosphere: float, voltage: float) -> np.ndarray:
    """Flows into both chambers [kg/s], the piston at rest in the middle."""
    outside = {"air.supply_pressure": supply, "air.atmospheric_pressure": atmosphere}
    still = in_python(model.with_parameters(outside))
    slope = still.derivatives(still.state(p_a=p_a, p_b=p_b), voltage)[0, 2:4]
    volumes = np.array([model["chambers.volume_a"], model["chambers.volume_b"]])
    return np.asarray(slope * volumes / (model["air.heat_capacity_ratio"] * 287.0 * 293.0))


def check_gas_flows_downhill(model: Model) -> None:
    """Gas flows from high to low pressure only, nothing flows between equal pressures, and none is made or lost."""
    for voltage in (-8.0, -1.0, 0.0, 0.5, 3.0, 10.0):
        assert np.abs(mass_rates(model, 2e5, 2e5, 2e5, 2e5, voltage)).max() < 1e-12, "between equal pressures"
        assert mass_rates(model, 7e5, 2e5, 6e5, 1e5, voltage)[0] <= 1e-15, "into the fullest chamber a"
        assert mass_rates(model, 2e5, 7e5, 6e5, 1e5, voltage)[1] <= 1e-15, "into the fullest chamber b"
        assert mass_rates(model, 1e5, 3e5, 6e5, 1.5e5, voltage)[0] >= -1e-15, "out of the emptiest chamber a"
        assert mass_rates(model, 3e5, 1e5, 6e5, 1.5e5, voltage)[1] >= -1e-15, "out of the emptiest chamber b"
        assert mass_rates(model, 7e5, 6.5e5, 6e5, 1e5, voltage).sum() <= 1e-15, "from nowhere"
        assert mass_rates(model, 1e5, 1.2e5, 6e5, 1.5e5, voltage).sum() >= -1e-15, "into nowhere"


def check_leak_is_closed(effect: type[Effect]) -> None:
    """Without supply and atmosphere, gas that leaves one chamber enters the other."""
    equations, outside = effect.functions.get("equations"), {"p_s", "p_atm", "supply_pressure", "atmospheric_pressure"}
    if equations is None or not {"flow_a", "flow_b"} & set(equations.writes) or outside & set(equations.reads):
        return
    random = seeded(effect.name)
    for _ in range(50):
        given = {a: argument(a, effect, random) for a in equations.reads}
        values = effect_function(effect, "equations")(**given)
        flows = dict(zip(equations.writes, values if isinstance(values, tuple) else (values,), strict=True))
        assert flows.get("flow_a", 0.0) == -flows.get("flow_b", 0.0), given


def bounded(model: Model, step: float, voltage: np.ndarray) -> bool:
    """Whether a long step gives no extreme value that a short one does not give; extremes in both are real."""
    start = model.state(p_a=3e5, p_b=4e5)
    coarse, fine = (np.abs(model.simulate(voltage, start, step=h)).max(axis=0) for h in (step, 2e-6))
    units = {key: state.unit for name in model.effects for key, state in model.library.find(name).states.items()}
    least = [step if units.get(name) == "s" else 1e-6 for name in model.states]  # a clock counts whole steps
    return bool(np.all(coarse <= 3.0 * fine + least))
