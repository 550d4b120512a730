"""Compressible flow through the valve's edges."""

from pneumo_ros.plant.effect import Effect, Parameter, atan, pi, sqrt

NORMAL_DENSITY = 1.185  # kg/m3 at 100 kPa and 293.15 K, ISO 6358-1
NORMAL_TEMPERATURE = 293.15  # K
LINEAR = 0.999  # pressure ratio above which the law is linear: the steep ellipse would turn noise into mean flow


def ratio_function(ratio: float, b: float) -> float:
    """Share of the sonic flow at a pressure ratio: 1 below b, an ellipse above, linear near 1."""
    bent = (min(max(ratio, b), LINEAR) - b) / (1.0 - b)
    knee = (LINEAR - b) / (1.0 - b)
    ellipse = sqrt(1.0 - bent * bent)
    line = (1.0 - ratio) / (1.0 - LINEAR) * sqrt(1.0 - knee * knee)
    return line if ratio > LINEAR else ellipse


def edge_flow(p_1: float, p_2: float, conductance: float, b: float, temperature: float) -> float:
    """Mass flow from p_1 to p_2 [kg/s], ISO 6358-1: C rho_0 p_1 sqrt(T_0 / T) psi(p_2 / p_1), odd in the direction."""
    high, low = max(p_1, p_2), min(p_1, p_2)
    flow = conductance * NORMAL_DENSITY * high * sqrt(NORMAL_TEMPERATURE / temperature) * ratio_function(low / high, b)
    return flow if p_1 > p_2 else -flow


class ChokedFlow(Effect):
    """ISO 6358 flow in place of the linear law: sonic conductance C and critical ratio b at full opening.

    Needs `arctan_flow` and replaces the share `blend` of its flow, through the same opening.
    """

    blend = Parameter(1.0, "1", "share of the flow that follows ISO 6358", low=0.0, high=1.0, neutral=0.0)
    conductance_filling = Parameter(5e-9, "m3/(s Pa)", "sonic conductance C of the filling edge", low=1e-11, high=1e-7)
    conductance_exhaust = Parameter(7e-9, "m3/(s Pa)", "sonic conductance C of the exhaust edge", low=1e-11, high=1e-7)
    critical_ratio = Parameter(0.3, "1", "critical pressure ratio b", low=0.0, high=0.9)

    source = "ISO 6358-1:2013; Beater 2007, Pneumatic Drives"
    signature = "at one voltage the flow error depends on the pressure ratio"

    def equations(
        opening, p_a, p_b, p_s, p_atm, temperature, arctan_flow__filling_coefficient, arctan_flow__exhaust_coefficient,
        arctan_flow__voltage_gain, blend, conductance_filling, conductance_exhaust, critical_ratio,
    ):  # fmt: skip
        phi = atan(arctan_flow__voltage_gain * opening)
        area = blend * abs(phi) * (2.0 / pi)
        fills_a = opening >= 0.0
        p_1a, p_2a = p_s if fills_a else p_a, p_a if fills_a else p_atm
        p_1b, p_2b = p_b if fills_a else p_s, p_atm if fills_a else p_b
        C_a = conductance_filling if fills_a else conductance_exhaust
        C_b = conductance_exhaust if fills_a else conductance_filling
        beta_a = arctan_flow__filling_coefficient if fills_a else arctan_flow__exhaust_coefficient
        beta_b = arctan_flow__exhaust_coefficient if fills_a else arctan_flow__filling_coefficient
        sense = 1.0 if fills_a else -1.0
        iso_a = area * edge_flow(p_1a, p_2a, C_a, critical_ratio, temperature)
        iso_b = area * edge_flow(p_1b, p_2b, C_b, critical_ratio, temperature)
        valve_flow_a = sense * (iso_a - blend * abs(phi) * beta_a * (p_1a - p_2a))
        valve_flow_b = -sense * (iso_b - blend * abs(phi) * beta_b * (p_1b - p_2b))
        return valve_flow_a, valve_flow_b
