"""Conversions of flow figures: the formula of catalogues, inverses, and the flow of the machine's own law."""

import math

import pytest

from pneumo_ros.parts import flow
from pneumo_ros.plant.effects.valve.choked_flow import NORMAL_DENSITY, edge_flow

LITRES_A_MINUTE = 1e-3 / 60.0


def test_nominal_flow_is_that_of_the_catalogues_formula() -> None:
    """Q [l/min] = 600 C (p + 0.1) sqrt(1 - ((r - b) / (1 - b))^2) with p [MPa gauge], C in dm3/(s bar), at 20 C."""
    C, b, r = 2.0, 0.3, 6.0 / 7.0
    by_hand = 600.0 * C * (0.6 + 0.1) * math.sqrt(1.0 - ((r - b) / (1.0 - b)) ** 2)
    assert flow.nominal_flow(C * 1e-8, b) / LITRES_A_MINUTE == pytest.approx(by_hand, rel=1e-12)


def test_nominal_flow_is_what_the_machine_lets_through() -> None:
    C = flow.of_nominal_flow(700.0 * LITRES_A_MINUTE, 0.27)
    mass_flow = edge_flow(7e5, 6e5, C, 0.27, 0.5, 293.15)
    assert mass_flow / NORMAL_DENSITY / LITRES_A_MINUTE == pytest.approx(700.0, rel=1e-12)
    assert flow.nominal_flow(C, 0.27) == pytest.approx(700.0 * LITRES_A_MINUTE, rel=1e-12)


@pytest.mark.parametrize("b", [0.2, 0.34, 0.5])
def test_kv_gives_the_flow_of_an_incompressible_gas_at_small_differences(b: float) -> None:
    """m' = C_d A sqrt(2 rho_1 dp), with the area that lets K_v of water through at 1 bar."""
    kv, p, T = 0.4, 7e5, 293.15
    area = kv / 3600.0 / math.sqrt(2.0 * 1e5 / 1000.0)
    difference = 2e-3 * p  # the law is linear below a thousandth
    wanted = area * math.sqrt(2.0 * p / (flow.GAS * T) * difference)
    assert edge_flow(p, p - difference, flow.of_kv(kv, b), b, 0.5, T) == pytest.approx(wanted, rel=2e-3)


def test_cv_is_kv_in_gallons_and_psi() -> None:
    """1 C_v = 0.865 K_v, as tables say."""
    assert flow.of_cv(1.0, 0.3) / flow.of_kv(1.0, 0.3) == pytest.approx(0.865, abs=5e-4)
