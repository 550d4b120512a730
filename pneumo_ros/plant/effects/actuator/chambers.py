"""A cylinder with air on both sides of its piston."""

from pneumo_ros.plant.actuator import Actuator
from pneumo_ros.plant.effect import Parameter, State, pi, sqrt


def round_bore(V: float, area: float, middle: float) -> float:
    """Walls of a round bore around the volume V [m3], over those around `middle` [m3]: S = 2 A + 4 V / d."""
    around = 4.0 / sqrt(4.0 * area / pi)
    return (2.0 * area + around * V) / (2.0 * area + around * middle)


class Chambers(Actuator):
    """Mass and energy balance of both chambers, Eqs. 3-4: p' = gamma (R T q - p V') / V + (gamma - 1) Q / V.

    The walls that the gas touches are those of a round bore of the area A of its side, d = sqrt(4 A / pi).
    """

    volume_a = Parameter(5.1e-4, "m3", "volume V_a0 of chamber a and its line at mid stroke", low=1e-8, high=10.0)
    volume_b = Parameter(4.0e-4, "m3", "volume V_b0 of chamber b and its line at mid stroke", low=1e-8, high=10.0)

    p_a = State("Pa", "pressure in chamber a, absolute", initial=1e5)
    p_b = State("Pa", "pressure in chamber b, absolute", initial=1e5)

    source = "paper Eqs. 3-4; heat flow as in Carneiro and de Almeida 2006"

    def equations(
        y, v, p_a, p_b, port_flow_a, port_flow_b, flow_a, flow_b, added_volume_a, added_volume_b, heat_a, heat_b,
        area_a, area_b, volume_a, volume_b, gas_constant, temperature, heat_capacity_ratio,
    ):  # fmt: skip
        gamma = heat_capacity_ratio
        R_T = gas_constant * temperature
        V_a = volume_a + added_volume_a + area_a * y
        V_b = volume_b + added_volume_b - area_b * y
        der_p_a = (gamma * (R_T * (port_flow_a + flow_a) - area_a * v * p_a) + (gamma - 1.0) * heat_a) / V_a
        der_p_b = (gamma * (R_T * (port_flow_b + flow_b) + area_b * v * p_b) + (gamma - 1.0) * heat_b) / V_b
        drive = area_a * p_a - area_b * p_b
        return der_p_a, der_p_b, drive

    def outputs(y, added_volume_a, added_volume_b, area_a, area_b, volume_a, volume_b):
        touched_a = round_bore(volume_a + added_volume_a + area_a * y, area_a, volume_a)
        touched_b = round_bore(volume_b + added_volume_b - area_b * y, area_b, volume_b)
        return touched_a, touched_b
