"""What the paper prints: Tables 1 and 2, and how each entry is read here.

R. R. M. Richter et al., "Friction dynamics mathematical modeling in special pneumatic cylinder".
"""

from typing import NamedTuple


class Entry(NamedTuple):
    """A row of a table: symbol and text as printed, the parameter of the machine file, its value in SI units."""

    symbol: str
    printed: str
    parameter: str
    value: float
    note: str = ""


TABLE_1 = (
    Entry("zmd", "0,78 volts", "dead_zone.right_limit", 0.78),
    Entry("zme", "0,78 volts", "dead_zone.left_limit", 0.78, "magnitude of -0.78 V"),
    Entry("md", "1", "dead_zone.right_slope", 1.0),
    Entry("me", "1", "dead_zone.left_slope", 1.0),
    Entry("beta_ench", "0.69501 x 10^-8", "arctan_flow.filling_coefficient", 0.69501e-8),
    Entry("beta_esv", "0.898105 x 10^-8", "arctan_flow.exhaust_coefficient", 0.898105e-8),
    Entry("p_s", "7 x 10^5 Pa", "air.supply_pressure", 7e5, "absolute"),
    Entry("p_atm", "1 x 10^5 Pa", "air.atmospheric_pressure", 1e5),
    Entry("R", "287 Jkg/K", "air.gas_constant", 287.0, "of air, J/(kg K)"),
    Entry("T", "293 K", "air.temperature", 293.0),
    Entry("gamma", "1.4", "air.heat_capacity_ratio", 1.4),
    Entry("A_1", "4.1 x 10^- m2", "piston.area_a", 4.1e-4, "exponent lost in print"),
    Entry("A_2", "3.0 x 10^- m2", "piston.area_b", 3.0e-4, "exponent lost in print"),
    Entry("V_a0", "5.1 x 10^- m3", "chambers.volume_a", 5.1e-4, "exponent lost in print"),
    Entry("V_b0", "4.0 x 10^-4 m3", "chambers.volume_b", 4.0e-4),
    Entry("z_ba", "0.9 z_max", "lugre_friction.breakaway_ratio", 0.9, "at every speed"),
    Entry("M", "5 kg", "piston.mass", 5.0),
)
TABLE_2 = (
    Entry("F_s", "100 N", "lugre_friction.static_friction", 100.0),
    Entry("F_c", "70 N", "lugre_friction.coulomb_friction", 70.0),
    Entry("C_d", "4546.7 Ns2/m2", "quadratic_drag.coefficient", 4546.7),
    Entry("v_s", "0.01 m/s", "lugre_friction.stribeck_velocity", 0.01),
    Entry("sigma_0", "1.4 x 10^6 N/m", "lugre_friction.bristle_stiffness", 1.4e6),
    Entry("sigma_1", "50 Ns/m", "lugre_friction.bristle_damping", 50.0),
)
