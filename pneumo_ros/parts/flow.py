"""Flow figures of valves, each as the sonic conductance C of ISO 6358-1.

    q_n = C p_1 psi(p_2 / p_1),  psi(r) = sqrt(1 - ((r - b) / (1 - b))^2) for r > b, else 1       ISO 6358-1

The nominal flow q_n is measured from 6 to 5 bar gauge. K_v and C_v measure water, which shows the effective area C_d A
at small pressure differences: K_v = C_d A sqrt(2 dp / rho) at 1 bar in m3/h, C_v at 1 psi in US gallons a minute. There
the law above equals C_d A sqrt(2 rho_1 dp) for

    C = C_d A sqrt(1 - b) / (rho_0 sqrt(R T_0)).
"""

import math

from pneumo_ros.parts.quantity import INCH, PSI
from pneumo_ros.plant.effects.valve.choked_flow import ELLIPSE, NORMAL_DENSITY, NORMAL_TEMPERATURE, ratio_function

GAS = 287.0  # J/(kg K), air
NOMINAL = (7e5, 6e5)  # Pa absolute, before and behind the valve: 6 and 5 bar gauge
WATER = 1000.0  # kg/m3, that K_v is defined for
GALLON = 231.0 * INCH**3  # m3, US


def of_nominal_flow(flow: float, b: float) -> float:
    """C [m3/(s Pa)] of a valve with the nominal flow [m3/s at reference conditions] and critical ratio b."""
    return flow / (NOMINAL[0] * ratio_function(NOMINAL[1] / NOMINAL[0], b, ELLIPSE))


def nominal_flow(conductance: float, b: float) -> float:
    """Nominal flow [m3/s at reference conditions] of C [m3/(s Pa)] and b: the inverse of `of_nominal_flow`."""
    return conductance * NOMINAL[0] * ratio_function(NOMINAL[1] / NOMINAL[0], b, ELLIPSE)


def of_kv(kv: float, b: float) -> float:
    """C [m3/(s Pa)] of a valve with flow coefficient K_v [m3/h of water at 1 bar] and critical ratio b."""
    return _of_area(kv / 3600.0 / math.sqrt(2.0 * 1e5 / WATER), b)


def of_cv(cv: float, b: float) -> float:
    """C [m3/(s Pa)] of a valve with flow coefficient C_v [US gal/min of water at 1 psi] and critical ratio b."""
    return _of_area(cv * GALLON / 60.0 / math.sqrt(2.0 * PSI / WATER), b)


def _of_area(area: float, b: float) -> float:
    return area * math.sqrt(1.0 - b) / (NORMAL_DENSITY * math.sqrt(GAS * NORMAL_TEMPERATURE))
