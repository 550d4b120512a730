"""Overlap of the valve spool."""

from pneumo_ros.plant.effect import Effect, Parameter


class DeadZone(Effect):
    """Dead zone of an overlapped spool with two limits and two slopes (paper Table 1; it acts before Eqs. 6-9)."""

    right_limit = Parameter(0.78, "V", "voltage u_r at which port a begins to fill", low=0.0, high=10.0, neutral=0.0)
    left_limit = Parameter(
        0.78, "V", "magnitude u_l of the voltage at which port a begins to empty", low=0.0, high=10.0, neutral=0.0
    )
    right_slope = Parameter(1.0, "V/V", "slope m_r beyond the right limit", low=0.01, high=100.0, neutral=1.0)
    left_slope = Parameter(1.0, "V/V", "slope m_l beyond the left limit", low=0.01, high=100.0, neutral=1.0)

    source = "paper Table 1; Valdiero et al. 2011"
    signature = "nothing moves for small voltages; flow begins beyond a threshold on either side"
    remedy = "nothing to repair: closed-centre valves have it; compensate it in the controller"

    def equations(spool, right_limit, left_limit, right_slope, left_slope):
        opening = 0.0
        if spool > right_limit:
            opening = right_slope * (spool - right_limit)
        elif spool < -left_limit:
            opening = left_slope * (spool + left_limit)
        return opening
