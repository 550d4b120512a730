"""Subsonic flow that is no ellipse."""

from pneumo_ros.plant.effect import Effect, Parameter


class SubsonicIndex(Effect):
    """Subsonic index m of ISO 6358: psi = (1 - ((r - b) / (1 - b))^2)^m at pressure ratios r above b.

    It shapes the flow of `choked_flow`, which has the ellipse of m = 1/2 without it.
    """

    index = Parameter(0.6, "1", "subsonic index m", low=0.3, high=1.0, neutral=0.5)

    source = "ISO 6358-1:2013, subsonic index; the elliptical law with 1/2 is that of ISO 6358:1989"
    signature = "near equal pressures the flow falls earlier, or later, than an ellipse; choked flow is unchanged"
    remedy = "nothing to repair: it is the curve of the valve; enter m of its data sheet"
    part = True

    def equations(choked_flow__blend, index):
        subsonic_power = index if choked_flow__blend > 0.0 else 0.5
        return subsonic_power
