"""The load of an arm: mass and force of one potential, as polynomials, and their coefficients from a URDF."""

import math
from pathlib import Path

import numpy as np
import pytest
import yaml
from numpy.polynomial import chebyshev

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import load_model, save_model
from pneumo_ros.plant.machine_file import machine_text
from pneumo_ros.plant.model import Model

AXIS = load_model("axis")
ARM = Path(__file__).parents[2] / "config" / "arm"
RNG = np.random.default_rng(5)
MASS = [60.0, *RNG.uniform(-4.0, 4.0, 8)]
ENERGY = [0.0, *RNG.uniform(-20.0, 20.0, 8)]
COEFFICIENTS = {f"arm_load.mass_{k}": value for k, value in enumerate(MASS)} | {
    f"arm_load.energy_{k}": value for k, value in enumerate(ENERGY) if k
}
ARMED = AXIS.with_effects(["rod_atmospheric_force", "arm_load"], COEFFICIENTS)


def test_mass_and_force_are_those_of_the_series() -> None:
    x, v = np.linspace(-1.0, 1.0, 41), 0.7
    reach = 0.5 * ARMED["piston.stroke"]
    states = np.array([ARMED.state(y=reach * one, v=v) for one in x])
    seen = ARMED.outputs(states)
    assert seen["added_mass"] == pytest.approx(chebyshev.chebval(x, MASS))
    slope, weight = (chebyshev.chebval(x, chebyshev.chebder(series)) / reach for series in (MASS, ENERGY))
    rod = ARMED["air.atmospheric_pressure"] * (ARMED["piston.area_a"] - ARMED["piston.area_b"])
    assert seen["force"] == pytest.approx(0.5 * slope * v**2 + weight + rod)


def test_a_coasting_arm_keeps_its_energy() -> None:
    """Without gas or friction the kinetic and the potential energy change into each other, and the mass with them."""
    piston = {name: value for name, value in AXIS.parameters.items() if name.startswith("piston.")}
    values = {**piston, **COEFFICIENTS, "piston.mass": 2.0}
    model = Model.build(["arm_load"], values, frame=("piston",))
    states = model.simulate(np.zeros(2000), model.state(y=0.1, v=0.4), sample_time=1e-3)
    x = 2.0 * states[:, 0] / model["piston.stroke"]
    assert np.ptp(x) > 0.2
    energy = 0.5 * (2.0 + chebyshev.chebval(x, MASS)) * states[:, 1] ** 2 + chebyshev.chebval(x, ENERGY)
    assert np.ptp(energy) < 1e-4 * np.ptp(chebyshev.chebval(x, ENERGY))


# --- from a URDF ------------------------------------------------------------------------------------------------------

pytest.importorskip("pinocchio", reason="comes with the arm extra")
LEVER = ARM / "lever.yaml"


def by_hand(angle: float) -> tuple[float, float, float]:
    """Position [m], effective mass [kg] and load [N] of the lever at an angle of its boom: a plane triangle."""
    pin, rod = np.array([0.05, -0.45]), 0.3 * np.array([math.cos(angle), math.sin(angle)])
    length = float(np.hypot(*(rod - pin)))
    lever = float(pin[1] * rod[0] - pin[0] * rod[1]) / length
    inertia = 0.97 + 8.0 * 0.5**2 + 0.01 + 3.0 * 1.2**2
    return length - 0.52, inertia / lever**2, 9.81 * math.cos(angle) * (8.0 * 0.5 + 3.0 * 1.2) / abs(lever)


@pytest.mark.parametrize("angle", [-0.4, -0.1, 0.0, 0.3, 0.45])
def test_the_lever_loads_its_rod_as_computed_by_hand(angle: float) -> None:
    model = load_model(LEVER)
    y, mass, load = by_hand(angle)
    seen = model.outputs(model.state(y=y)[None])
    rod = model["air.atmospheric_pressure"] * (model["piston.area_a"] - model["piston.area_b"])
    assert float(seen["added_mass"][0]) == pytest.approx(mass, rel=1e-4)
    assert float(seen["force"][0]) - rod == pytest.approx(load, rel=1e-4)


def test_what_is_written_needs_no_urdf_any_more(tmp_path: Path) -> None:
    model = load_model(LEVER)
    again = load_model(save_model(model, tmp_path / "alone.yaml"))
    assert dict(again.parameters) == dict(model.parameters)


def changed(folder: Path, **entries: object) -> Path:
    """The lever's machine file with other entries in its section."""
    document = yaml.safe_load(LEVER.read_text())
    section = document["/**"]["ros__parameters"]["arm_load"]
    section |= {"urdf": str(ARM / "lever.urdf")} | entries
    for key in [key for key, value in section.items() if value is None]:
        del section[key]
    (folder / "changed.yaml").write_text(yaml.safe_dump(document))
    return folder / "changed.yaml"


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ({"urdf": "nowhere.urdf"}, "nowhere.urdf cannot be read"),
        ({"joint": "sholder"}, "did you mean shoulder"),
        ({"between": ["base_pin", "rod_pn"]}, "did you mean rod_pin"),
        ({"between": None}, "shoulder turns; name the links"),
        ({"between": ["rod_pin"]}, "two links"),
        ({"length": 0.9}, "is reached 0 times"),
        ({"length": 0.62}, "close to a dead point|between its dead points"),
        ({"lenght": 0.5}, "did you mean length"),
        ({"at": {"elbow": 1.0}}, "elbow"),
        ({"gravity": [0, 0]}, "three numbers"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_the_nearest_name(tmp_path: Path, entries: dict, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        load_model(changed(tmp_path, **entries))


def test_without_gravity_only_the_mass_is_left(tmp_path: Path) -> None:
    model = load_model(changed(tmp_path, gravity=[0.0, 0.0, 0.0]))
    assert all(model[f"arm_load.energy_{k}"] == pytest.approx(0.0, abs=1e-9) for k in range(1, 9))
    assert model["arm_load.mass_0"] == pytest.approx(load_model(LEVER)["arm_load.mass_0"])


def test_a_joint_that_slides_carries_what_hangs_on_it(tmp_path: Path) -> None:
    """The lift of the pruning arm: its machine file has the same mass and load as constants."""
    xacro = pytest.importorskip("xacro", reason="comes with the dev extra, or with a ROS 2 distribution")
    urdf = Path(__file__).parents[2] / "urdf" / "pruning_arm.urdf.xacro"
    (tmp_path / "arm.urdf").write_text(xacro.process_file(str(urdf)).toxml())
    lift = load_model(ARM / "lift.yaml")
    text = machine_text(lift.with_effects([name for name in lift.effects if name != "constant_load"]))
    text = text.replace("end_stop]", "end_stop, arm_load]")
    section = "    arm_load: {urdf: arm.urdf, joint: lift_piston, at: {reach_piston: 0.2}}\n"
    (tmp_path / "lift.yaml").write_text(text + section)
    seen = load_model(tmp_path / "lift.yaml")
    assert seen["arm_load.mass_0"] == pytest.approx(lift["piston.mass"])
    assert seen["arm_load.energy_1"] == pytest.approx(
        lift["constant_load.load"] * 0.5 * lift["piston.stroke"], rel=1e-3
    )
    assert max(abs(seen[f"arm_load.mass_{k}"]) for k in range(1, 9)) < 1e-9
