"""The ends of the stroke."""

from pneumo_ros.plant.effect import Effect, Parameter


class EndStop(Effect):
    """Compliant end stops beyond either end of the stroke, F = k x (1 + d x'), that push and never pull.

    Damping in proportion to the penetration x keeps the force continuous at contact, unlike a linear damper.
    """

    stiffness = Parameter(1e6, "N/m", "contact stiffness k", low=1e3, high=1e8)
    damping = Parameter(5.0, "s/m", "contact damping d; about 1 / impact speed is strong", low=0.0, high=1e3)

    source = "Hunt and Crossley 1975, Coefficient of restitution interpreted as damping in vibroimpact"
    signature = "velocity drops to zero at a fixed position while the pressures go on"
    remedy = "nothing to repair: every cylinder ends somewhere; enter the true stroke"

    def equations(y, v, stroke, stiffness, damping):
        over = max(y - 0.5 * stroke, 0.0)
        under = max(-y - 0.5 * stroke, 0.0)
        push_back = stiffness * over * max(1.0 + damping * v, 0.0)
        push_out = stiffness * under * max(1.0 - damping * v, 0.0)
        force = push_back - push_out
        resistance = stiffness * damping * (over + under)
        return force, resistance
