"""On what the readings of sensors depend."""

from pathlib import Path

import numpy as np

from pneumo_ros.plant import Model, load_model
from pneumo_ros.plant.library import Library
from pneumo_ros.runs.readings import must_drive, sensing

BRACKET = """from pneumo_ros.plant.effect import Effect, Parameter


class SoftBracket(Effect):
    'The bracket of the position sensor gives way to friction.'

    softness = Parameter(1e-6, "m/N", "softness", low=0.0, high=1e-3, neutral=0.0)

    def equations(y_measured, friction, softness):
        y_measured = y_measured + softness * friction
        return y_measured
"""


def lanes(model: Model, **values: float) -> np.ndarray:
    """Parameter vectors (2, parameters): those of the model, and with some values of its last effect changed."""
    other = model.with_parameters({f"{model.effects[-1]}.{key}": value for key, value in values.items()})
    return np.stack([model.values, other.values])


def test_roles_tell_how_a_late_reading_is_inverted() -> None:
    base = load_model("axis")
    late = base.with_effects([*base.effects, "position_sensor_delay"], {"position_sensor_delay.delay": 0.0})
    both = lanes(late, delay=8e-3)
    assert sensing(late, both).tolist() == must_drive(late, both).tolist() == [False, True]
    assert must_drive(late, both, untold=True).tolist() == [False, False]


def test_a_reading_that_depends_on_a_signal_is_driven(tmp_path: Path) -> None:
    """Friction has a state of its own, which the effect does not name: with it at rest, the bracket would not bend."""
    file = tmp_path / "soft_bracket.py"
    file.write_text(BRACKET, encoding="utf-8")
    base = load_model("axis")
    given = {**base.parameters, "soft_bracket.softness": 0.0}
    soft = Model.build([*base.effects, "soft_bracket"], given, name="soft", library=Library([file]))
    both = lanes(soft, softness=1e-6)
    assert must_drive(soft, both).tolist() == must_drive(soft, both, untold=True).tolist() == [False, True]


def test_a_gain_is_inverted_without_driving_anything() -> None:
    base = load_model("axis")
    wrong = base.with_effects([*base.effects, "pressure_sensor_gain"], {"pressure_sensor_gain.error_a": 0.0})
    both = lanes(wrong, error_a=0.02)
    assert sensing(wrong, both)[1]
    assert not must_drive(wrong, both).any()
