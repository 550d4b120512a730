"""The atmosphere on the rod."""

from pneumo_ros.plant.effect import Effect


class RodAtmosphericForce(Effect):
    """Force of the atmosphere on the rod's cross section, p_atm (A_a - A_b); Eq. 2 as printed lacks it."""

    source = "force balance of a single-rod cylinder, e.g. Beater 2007, Pneumatic Drives, ch. 5"
    signature = "a constant force of known value, present at rest"
    remedy = "nothing to repair: the atmosphere pushes on every rod; keep it in the model"

    def equations(p_atm, area_a, area_b):
        force = p_atm * (area_a - area_b)
        return force
