"""PVA: each term of its output, and its behaviour on the plant."""

import pytest
from control.following import follow, law_for

from pneumo_ros.control import Machine, Measurement, Pva, Setpoint, ValveInverse
from pneumo_ros.control.figures import tracking
from pneumo_ros.control.reference import sine

OPEN = ValveInverse(right_limit=0.0, left_limit=0.0, smoothing=0.0)  # voltage is opening
BARE = dict.fromkeys(("proportional", "derivative", "acceleration", "force", "integral"), 0.0)
FREE = Machine(static_friction=0.0, coulomb_friction=1e-3, drag=0.0, bristle_stiffness=1e3)
BALANCED = 3e5, (4.1e-4 * 3e5 - 11.0) / 3e-4  # Pa, without force on the piston


def first(setpoint: Setpoint, position: float = 0.0, **gains: float) -> float:
    """Output for the first measurement, at rest."""
    return Pva({**BARE, **gains}, OPEN, FREE).step(setpoint, Measurement(0.0, position, None, *BALANCED))


def test_errors_of_position_velocity_and_acceleration_add() -> None:
    assert first(Setpoint(0.01), proportional=50.0) == pytest.approx(0.5)
    feed = first(Setpoint(0.0, 0.05))
    assert first(Setpoint(0.0, 0.05), derivative=20.0) - feed == pytest.approx(1.0)
    assert first(Setpoint(0.0, 0.05, 0.3), acceleration=2.0) - feed == pytest.approx(0.6)


def test_the_force_that_the_motion_needs_is_fed_back_while_motion_is_wanted() -> None:
    feed = first(Setpoint(0.0, 0.05))
    assert first(Setpoint(0.0, 0.05, 2.0), force=0.1) - feed == pytest.approx(0.1 * 5.0 * 2.0, abs=1e-3)
    assert first(Setpoint(0.0), 0.0, force=0.1) == 0.0


def test_the_feedforward_holds_the_force_at_the_wanted_velocity() -> None:
    """Air has to flow for the piston to move: the opening grows with the velocity and changes its sign with it."""
    slow, fast, back = (first(Setpoint(0.0, v)) for v in (0.05, 0.1, -0.1))
    assert 0.0 < slow < fast
    assert back < 0.0


def test_the_integral_works_at_rest_only() -> None:
    for velocity, grows in ((0.0, True), (0.02, False)):
        law = Pva({**BARE, "integral": 10.0}, OPEN, FREE)
        answers = [law.step(Setpoint(0.01, velocity), Measurement(0.1 * k, 0.0, 0.0, *BALANCED)) for k in range(10)]
        assert (answers[-1] - answers[0] == pytest.approx(10.0 * 0.01 * 0.8)) == grows  # it acts a sample later


def test_it_follows_a_sine() -> None:
    assert tracking(follow(law_for("pva"), sine(0.3, 0.05), 20.0), 5.0).rms < 4e-3
