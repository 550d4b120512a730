"""The checks that every effect must pass find faults: each against an effect made to fail it."""

import numpy as np
import pytest
from plant import checks
from plant.units import DimensionError, unit

from pneumo_ros.plant import Effect, Model, load_model

EFFECTS = '''
from pneumo_ros.plant import Effect, Parameter


class SealLeak(Effect):
    """Turbulent leakage across the piston seal."""

    conductance = Parameter(2e-11, "kg/(s*sqrt(Pa))", "seal leak coefficient", low=0.0, high=1e-9)
    threshold = Parameter(1.0, "Pa", "regularisation near zero pressure difference", low=1e-3, high=1e3)
    source = "a textbook"
    signature = "equal and opposite residuals"

    def equations(p_a, p_b, conductance, threshold):
        leak = conductance * (p_a - p_b) / sqrt(abs(p_a - p_b) + threshold)
        flow_a, flow_b = -leak, leak
        return flow_a, flow_b


class SpeedForce(Effect):
    """A speed that is taken for a force."""

    def equations(v):
        friction = v
        return friction


class Mixture(Effect):
    """A pressure added to a speed."""

    def equations(v, p_a):
        friction = 0.0 * (v + p_a)
        return friction


class Motor(Effect):
    """Friction that pushes."""

    viscosity = Parameter(-50.0, "N s/m", "slope of the force", low=-100.0, high=-1.0)

    def equations(v, viscosity):
        friction = viscosity * v
        return friction


class Spring(Effect):
    """Air from nothing."""

    def equations(p_b):
        flow_a = 1e-6 * p_b / 1e5
        return flow_a


class Uphill(Effect):
    """A pump without a motor, from b to a."""

    conductance = Parameter(1e-9, "kg/(s Pa)", "pumping conductance", low=0.0, high=1e-8)

    def equations(p_a, p_b, conductance):
        flow_a = conductance * (p_a - p_b)
        flow_b = -flow_a
        return flow_a, flow_b


class Pole(Effect):
    """Infinite at a permitted parameter."""

    length = Parameter(1.0, "m", "a length that may vanish", low=0.0, high=1.0)

    def equations(y, length):
        friction = 1.0 / length
        return friction
'''


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Model:
    path = tmp_path_factory.mktemp("effects") / "questionable.py"
    path.write_text(EFFECTS)
    return load_model("axis", [path])


def taken(base: Model, name: str) -> tuple[Model, type[Effect]]:
    """The axis with an effect of the file, and the effect."""
    return base.with_effects([*base.effects, name]), base.library.find(name)


def test_a_good_effect_passes_them_all(base: Model) -> None:
    model, effect = taken(base, "seal_leak")
    checks.check_documentation(effect)
    checks.check_units(effect)
    checks.check_equations_are_finite(effect)
    checks.check_machine_is_finite(model, effect)
    checks.check_dissipation(model, effect)
    checks.check_gas_flows_downhill(model)
    checks.check_leak_is_closed(effect)


def test_missing_words_are_found(base: Model) -> None:
    with pytest.raises(AssertionError, match="source"):
        checks.check_documentation(base.library.find("speed_force"))
    with pytest.raises(AssertionError, match="docstring"):
        checks.check_documentation(base.library.find("motor"))


@pytest.mark.parametrize(("name", "error"), [("speed_force", AssertionError), ("mixture", DimensionError)])
def test_wrong_units_are_found(base: Model, name: str, error: type[Exception]) -> None:
    with pytest.raises(error, match=r"declared|does not go with"):
        checks.check_units(base.library.find(name))


def test_driving_friction_is_found(base: Model) -> None:
    lone = base.with_effects(["motor"])
    with pytest.raises(AssertionError, match="J over"):
        checks.check_dissipation(lone, base.library.find("motor"))


@pytest.mark.parametrize("name", ["spring", "uphill"])
def test_made_and_climbing_gas_is_found(base: Model, name: str) -> None:
    with pytest.raises(AssertionError, match=r"equal pressures|fullest"):
        checks.check_gas_flows_downhill(taken(base, name)[0])


def test_open_leak_is_found(base: Model) -> None:
    with pytest.raises(AssertionError):
        checks.check_leak_is_closed(base.library.find("spring"))


def test_poles_are_found(base: Model) -> None:
    model, effect = taken(base, "pole")
    with pytest.raises((AssertionError, ZeroDivisionError)):
        checks.check_equations_are_finite(effect)
    with pytest.raises(AssertionError), np.errstate(divide="ignore"):
        checks.check_machine_is_finite(model, effect)


@pytest.mark.parametrize(
    "text", ["N s2/m2", "kg/(s Pa)", "kg/(s*sqrt(Pa))", "m3/(s Pa)", "1/V", "V/V", "J/(kg K)", "1"]
)
def test_units_are_read(text: str) -> None:
    assert unit(text).value == 1.0


@pytest.mark.parametrize("text", ["furlong", "N s/", "kg^2", "", "__import__('os')"])
def test_what_is_no_unit_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="no unit"):
        unit(text)


def test_units_are_distinguished() -> None:
    assert unit("N s2/m2").base == {"kg": 1, "m": -1}
    assert unit("kg/(s*sqrt(Pa))").base == unit("kg").base | {"kg": 0.5, "m": 0.5}
