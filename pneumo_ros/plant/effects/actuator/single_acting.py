"""A cylinder with air on one side of its piston."""

from pneumo_ros.plant.actuator import Actuator
from pneumo_ros.plant.effect import Parameter, State
from pneumo_ros.plant.effects.actuator.chambers import round_bore


class SingleActing(Actuator):
    """Air on one side, Eqs. 2-3; on the other the atmosphere, and a spring that pushes back, linear over the stroke.

    F = A_a p_a - A_b p_atm - F_0 - (F_1 - F_0) (y / stroke + 1/2). Without spring the atmosphere and the load return
    the piston. Without a valve the chamber is sealed: a gas spring, whose A_a is the area of its rod. The walls that
    the gas touches are those of a round bore of the area A_a.
    """

    volume_a = Parameter(5.1e-4, "m3", "volume V_a0 of chamber a and its line at mid stroke", low=1e-8, high=10.0)
    spring_retracted = Parameter(0.0, "N", "force F_0 of the spring, rod retracted", low=0.0, high=1e5, neutral=0.0)
    spring_extended = Parameter(0.0, "N", "force F_1 of the spring, rod extended", low=0.0, high=1e5, neutral=0.0)

    p_a = State("Pa", "pressure in chamber a, absolute", initial=1e5)

    source = "paper Eqs. 2-3 with chamber b open; Beater 2007, Pneumatic Drives (single-acting cylinders)"

    def equations(
        y, v, p_a, port_flow_a, flow_a, added_volume_a, heat_a, p_atm, area_a, area_b, stroke, volume_a,
        spring_retracted, spring_extended, gas_constant, temperature, heat_capacity_ratio,
    ):  # fmt: skip
        gamma = heat_capacity_ratio
        V_a = volume_a + added_volume_a + area_a * y
        inflow = gas_constant * temperature * (port_flow_a + flow_a)
        der_p_a = (gamma * (inflow - area_a * v * p_a) + (gamma - 1.0) * heat_a) / V_a
        spring = spring_retracted + (spring_extended - spring_retracted) * (y / stroke + 0.5)
        drive = area_a * p_a - area_b * p_atm - spring
        return der_p_a, drive

    def outputs(y, added_volume_a, area_a, volume_a):
        touched_a = round_bore(volume_a + added_volume_a + area_a * y, area_a, volume_a)
        return touched_a
