"""Paths of a valve that choke at different pressure ratios."""

from pneumo_ros.plant.effect import Effect, Parameter

LEAST, MOST = 0.0, 0.95  # critical pressure ratios that a path may have


def limited(b: float) -> float:
    """A critical pressure ratio within its limits."""
    return min(max(b, LEAST), MOST)


class PathCriticalRatios(Effect):
    """Each path of the valve has its own critical pressure ratio, around the b of `choked_flow`.

    b_PA = b - e / 2 - f / 2, b_PB = b - e / 2 + f / 2, b_AT = b + e / 2 - g / 2, b_BT = b + e / 2 + g / 2.
    """

    exhaust_excess = Parameter(
        0.1, "1", "ratio e of the exhaust paths above that of the filling paths", low=-0.9, high=0.9, neutral=0.0
    )
    filling_difference = Parameter(0.0, "1", "ratio f of P-B above that of P-A", low=-0.9, high=0.9, neutral=0.0)
    exhaust_difference = Parameter(0.0, "1", "ratio g of B-T above that of A-T", low=-0.9, high=0.9, neutral=0.0)

    source = "ISO 6358-1:2013, which states C and b of each flow path"
    signature = "the flow of one path falls with the pressure behind it earlier than that of another"
    remedy = "nothing to repair: it is the curve of the valve; enter b of each path of its data sheet"
    part = True

    def equations(choked_flow__critical_ratio, exhaust_excess, filling_difference, exhaust_difference):
        filling = choked_flow__critical_ratio - 0.5 * exhaust_excess
        exhaust = choked_flow__critical_ratio + 0.5 * exhaust_excess
        ratio_pa, ratio_pb = limited(filling - 0.5 * filling_difference), limited(filling + 0.5 * filling_difference)
        ratio_at, ratio_bt = limited(exhaust - 0.5 * exhaust_difference), limited(exhaust + 0.5 * exhaust_difference)
        return ratio_pa, ratio_at, ratio_pb, ratio_bt
