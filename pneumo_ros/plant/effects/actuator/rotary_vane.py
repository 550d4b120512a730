"""A vane that turns in a round casing, with air on both of its sides."""

from pneumo_ros.plant.actuator import Actuator
from pneumo_ros.plant.effect import Parameter
from pneumo_ros.plant.effects.actuator.chambers import Chambers


class RotaryVane(Actuator):
    """Balances of both chambers, Eqs. 3-4, over the angle y; torque M = D_a p_a - D_b p_b of the swept volumes D.

    A vane of width b between radii r_1 and r_2 sweeps D = b (r_2^2 - r_1^2) / 2 per radian on both of its sides; n
    vanes sweep n times as much. D_a and D_b are `area_a` and `area_b` of the piston, in m3/rad.
    """

    volume_a = Parameter(5e-4, "m3", "volume V_a0 of chamber a and its line at mid stroke", low=1e-8, high=10.0)
    volume_b = Parameter(5e-4, "m3", "volume V_b0 of chamber b and its line at mid stroke", low=1e-8, high=10.0)

    p_a, p_b = Chambers.p_a, Chambers.p_b

    coordinate = "rotation"
    source = "paper Eqs. 3-4 over an angle; Beater 2007, Pneumatic Drives (rotary actuators)"

    equations = Chambers.equations

    def caution(piston__area_a, piston__area_b):
        if abs(piston__area_a - piston__area_b) > 0.1 * max(piston__area_a, piston__area_b):
            return "a vane sweeps equal volumes per radian on both sides, and piston.area_a and area_b differ"
        return ""
