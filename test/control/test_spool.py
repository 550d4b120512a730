"""The sped-up spool, on the spool of the plant."""

import numpy as np
import pytest
from control.following import AXIS, follow, law_for

from pneumo_ros.control import Machine
from pneumo_ros.control.figures import arrivals
from pneumo_ros.control.reference import moves
from pneumo_ros.control.spool import FASTER, SpoolLead
from pneumo_ros.plant import Stepper

SLOW = AXIS.with_effects([*AXIS.effects, "valve_spool_dynamics"])
OMEGA = SLOW["valve_spool_dynamics.angular_frequency"]
MACHINE = Machine.of(SLOW.effects, SLOW.parameters)


def spool_after(lead: SpoolLead | None, wanted: float, samples: int, limit: float = 100.0) -> np.ndarray:
    """Positions of the plant's spool at every millisecond after the wanted one has jumped."""
    plant = Stepper(SLOW, SLOW.state(p_a=3e5, p_b=3.7e5), sample_time=1e-3)
    given = (lead.voltage(MACHINE, wanted, limit, 1e-3) if lead else wanted for _ in range(samples))
    return np.array([plant.advance(volts)[SLOW.states.index("x_s")] for volts in given])


def test_the_spool_arrives_as_one_of_that_frequency_would() -> None:
    time = 1e-3 * np.arange(1, 81)
    fast = FASTER * OMEGA
    wanted = 1.0 - (1.0 + fast * time) * np.exp(-fast * time)  # critically damped
    assert spool_after(SpoolLead(), 1.0, 80) == pytest.approx(wanted, abs=0.06)
    assert np.abs(spool_after(None, 1.0, 80) - wanted).max() > 0.25


def test_the_voltage_stays_within_its_limit_and_the_spool_arrives_all_the_same() -> None:
    lead = SpoolLead()
    assert max(lead.voltage(MACHINE, 5.0, 6.0, 1e-3) for _ in range(50)) == 6.0
    assert spool_after(SpoolLead(), 5.0, 200, 6.0)[-1] == pytest.approx(5.0, abs=0.05)


def test_a_spool_without_lag_gets_what_is_wanted() -> None:
    assert SpoolLead().voltage(Machine(), 3.21, 10.0, 1e-3) == 3.21


def test_moves_end_better_once_the_machine_file_knows_the_spool() -> None:
    way = moves([0.0, 0.06, 0.0], 6.0, 1.0)
    known = arrivals(follow(law_for("cascade", SLOW), way, 18.0, SLOW), 6.0)
    assert max(end.error for end in known) < 3e-4
