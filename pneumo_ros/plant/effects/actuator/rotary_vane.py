"""A vane that turns in a round casing, with air on both of its sides."""

from pneumo_ros.plant.actuator import Actuator
from pneumo_ros.plant.effect import Parameter
from pneumo_ros.plant.effects.actuator.chambers import Chambers


class RotaryVane(Actuator):
    """Balances of both chambers, Eqs. 3-4, over the angle y; torque M = D_a p_a - D_b p_b of the swept volumes D.

    A vane of width b between radii r_1 and r_2 sweeps D = b (r_2^2 - r_1^2) / 2 per radian on both of its sides; n
    vanes sweep n times as much. D_a and D_b are `area_a` and `area_b` of the piston, in m3/rad.

    A chamber between vane and stop has six walls: vane and stop of b h with h = r_2 - r_1, and over the angle phi both
    sides (r_2^2 - r_1^2) phi, casing and hub b (r_1 + r_2) phi. With V = b (r_2^2 - r_1^2) phi / 2 those of n vanes are
    S = 2 n b h + 2 (1 / b + 1 / h) V, as of a straight bore of the vane's face (geometry). S grows as V_w + V, with the
    volume V_w = n b^2 h^2 / (b + h) at which the walls along the way equal vane and stop.
    """

    volume_a = Parameter(5e-4, "m3", "volume V_a0 of chamber a and its line at mid stroke", low=1e-8, high=10.0)
    volume_b = Parameter(5e-4, "m3", "volume V_b0 of chamber b and its line at mid stroke", low=1e-8, high=10.0)

    wall_volume = Parameter(
        0.0, "m3", "volume V_w, n b^2 h^2 / (b + h), of n vanes b wide and h high; 0: vane and stop are small walls",
        low=0.0, high=10.0, optional=True, chosen=True,
    )  # fmt: skip

    p_a, p_b = Chambers.p_a, Chambers.p_b

    coordinate = "rotation"
    source = "paper Eqs. 3-4 over an angle; Beater 2007, Pneumatic Drives (rotary actuators)"

    equations = Chambers.equations

    def outputs(y, added_volume_a, added_volume_b, area_a, area_b, volume_a, volume_b, wall_volume):
        V_a = volume_a + added_volume_a + area_a * y
        V_b = volume_b + added_volume_b - area_b * y
        touched_a = (wall_volume + V_a) / (wall_volume + volume_a)
        touched_b = (wall_volume + V_b) / (wall_volume + volume_b)
        return touched_a, touched_b

    def caution(piston__area_a, piston__area_b):
        if abs(piston__area_a - piston__area_b) > 0.1 * max(piston__area_a, piston__area_b):
            return "a vane sweeps equal volumes per radian on both sides, and piston.area_a and area_b differ"
        return ""
