"""Paths of a valve that do not pass alike."""

from pneumo_ros.plant.effect import Effect, Parameter


class PathConductances(Effect):
    """Each path of the valve has its own conductance: P-A and P-B differ, and so do A-T and B-T.

    C_PA = C_filling (1 - d / 2), C_PB = C_filling (1 + d / 2), and likewise C_AT and C_BT of C_exhaust with another d.
    The coefficients of `arctan_flow` are shared out in the same way.
    """

    filling_difference = Parameter(
        0.1, "1", "conductance of P-B less that of P-A, over their mean", low=-1.8, high=1.8, neutral=0.0
    )
    exhaust_difference = Parameter(
        0.1, "1", "conductance of B-T less that of A-T, over their mean", low=-1.8, high=1.8, neutral=0.0
    )

    source = "ISO 6358-1:2013, which states C and b of each flow path"
    signature = "both chambers fill, or empty, at different rates at the same opening and pressures"
    remedy = "compare each path's C with the data sheet; a path below it has dirt, a silencer or a narrow fitting"
    part = True

    def equations(filling_difference, exhaust_difference):
        share_pa, share_pb = 1.0 - 0.5 * filling_difference, 1.0 + 0.5 * filling_difference
        share_at, share_bt = 1.0 - 0.5 * exhaust_difference, 1.0 + 0.5 * exhaust_difference
        return share_pa, share_at, share_pb, share_bt
