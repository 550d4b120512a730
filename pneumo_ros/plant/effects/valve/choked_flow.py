"""Compressible flow through the valve's edges."""

from pneumo_ros.plant.effect import Effect, Parameter, atan, pi, power, sqrt

NORMAL_DENSITY = 1.185  # kg/m3 at 100 kPa and 293.15 K, ISO 6358-1
NORMAL_TEMPERATURE = 293.15  # K
ELLIPSE = 0.5  # subsonic index m of the elliptical law
LINEAR = 0.999  # pressure ratio above which the law is linear: the steep ellipse would turn noise into mean flow


def ratio_function(ratio: float, b: float, m: float) -> float:
    """Share of the sonic flow at a pressure ratio: 1 below b, (1 - x^2)^m above, an ellipse for m = 1/2, linear near 1.

    x = (ratio - b) / (1 - b).
    """
    bent = (min(max(ratio, b), LINEAR) - b) / (1.0 - b)
    knee = (LINEAR - b) / (1.0 - b)
    ellipse = root(1.0 - bent * bent, m)
    line = (1.0 - ratio) / (1.0 - LINEAR) * root(1.0 - knee * knee, m)
    return line if ratio > LINEAR else ellipse


def root(x: float, m: float) -> float:
    """x**m, with the quick square root where m is 1/2."""
    return sqrt(x) if m == ELLIPSE else power(x, m)


def edge_flow(p_1: float, p_2: float, conductance: float, b: float, m: float, temperature: float) -> float:
    """Mass flow from p_1 to p_2 [kg/s], ISO 6358-1: C rho_0 p_1 sqrt(T_0 / T) psi(p_2 / p_1), odd in the direction."""
    high, low = max(p_1, p_2), min(p_1, p_2)
    sonic = conductance * NORMAL_DENSITY * high * sqrt(NORMAL_TEMPERATURE / temperature)
    flow = sonic * ratio_function(low / high, b, m)
    return flow if p_1 > p_2 else -flow


class ChokedFlow(Effect):
    """ISO 6358 flow in place of the linear law: sonic conductance C and critical ratio b at full opening.

    Needs `arctan_flow` and replaces the share `blend` of its flow, through the same opening.
    """

    blend = Parameter(1.0, "1", "share of the flow that follows ISO 6358", low=0.0, high=1.0, neutral=0.0)
    conductance_filling = Parameter(5e-9, "m3/(s Pa)", "sonic conductance C of the filling edge", low=1e-11, high=1e-6)
    conductance_exhaust = Parameter(7e-9, "m3/(s Pa)", "sonic conductance C of the exhaust edge", low=1e-11, high=1e-6)
    critical_ratio = Parameter(0.3, "1", "critical pressure ratio b", low=0.0, high=0.9)

    source = "ISO 6358-1:2013; Beater 2007, Pneumatic Drives"
    signature = "at one voltage the flow error depends on the pressure ratio"
    remedy = "nothing to repair: it is the curve of the valve; enter C and b of its data sheet"

    def equations(
        opening_a, opening_b, share_pa, share_at, share_pb, share_bt, ratio_pa, ratio_at, ratio_pb, ratio_bt,
        subsonic_power, p_a, p_b, p_s, p_atm, temperature, arctan_flow__filling_coefficient,
        arctan_flow__exhaust_coefficient, arctan_flow__voltage_gain, blend, conductance_filling, conductance_exhaust,
    ):  # fmt: skip
        fills_a, fills_b = opening_a >= 0.0, opening_b > 0.0
        linear_a = arctan_flow__filling_coefficient if fills_a else arctan_flow__exhaust_coefficient
        linear_b = arctan_flow__filling_coefficient if fills_b else arctan_flow__exhaust_coefficient
        iso_a = edge_flow(
            p_s if fills_a else p_a, p_a if fills_a else p_atm, conductance_filling if fills_a else conductance_exhaust,
            ratio_pa if fills_a else ratio_at, subsonic_power, temperature,
        )  # fmt: skip
        iso_b = edge_flow(
            p_s if fills_b else p_b, p_b if fills_b else p_atm, conductance_filling if fills_b else conductance_exhaust,
            ratio_pb if fills_b else ratio_bt, subsonic_power, temperature,
        )  # fmt: skip
        beyond_a = iso_a * (2.0 / pi) - linear_a * (p_s - p_a if fills_a else p_a - p_atm)
        beyond_b = iso_b * (2.0 / pi) - linear_b * (p_s - p_b if fills_b else p_b - p_atm)
        open_a = (share_pa if fills_a else share_at) * atan(arctan_flow__voltage_gain * opening_a)
        open_b = (share_pb if fills_b else share_bt) * atan(arctan_flow__voltage_gain * opening_b)
        valve_flow_a = blend * open_a * beyond_a
        valve_flow_b = blend * open_b * beyond_b
        return valve_flow_a, valve_flow_b
