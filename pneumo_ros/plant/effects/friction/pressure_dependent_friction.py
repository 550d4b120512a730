"""Friction of seals that the chamber pressure presses on."""

from pneumo_ros.plant.effect import Effect, Parameter


class PressureDependentFriction(Effect):
    """Coulomb and static friction rise with the mean chamber pressure: F_c, F_s += k ((p_a + p_b) / 2 - p_atm)."""

    coefficient = Parameter(3e-5, "N/Pa", "rise k of friction with mean pressure", low=0.0, high=1e-2, neutral=0.0)

    source = "Belforte, Raparelli and Velardocchia 1993, Study of the behavior of lip seals in pneumatic actuators"
    signature = "friction follows the level of both chamber pressures"
    remedy = "nothing to repair: lip seals have it; softer or low-friction seals reduce it"

    def equations(p_a, p_b, p_atm, coefficient):
        friction_rise = coefficient * max(0.5 * (p_a + p_b) - p_atm, 0.0)
        return friction_rise
