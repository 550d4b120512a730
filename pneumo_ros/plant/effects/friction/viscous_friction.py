"""Friction in proportion to velocity."""

from pneumo_ros.plant.effect import Effect, Parameter


class ViscousFriction(Effect):
    """Viscous friction F = sigma_2 v, the memoryless linear term of LuGre's f(v)."""

    coefficient = Parameter(30.0, "N s/m", "viscous friction coefficient sigma_2", low=0.0, high=1e6, neutral=0.0)

    source = "Canudas de Wit et al. 1995, Eq. 3"
    signature = "residual force in proportion to velocity"
    remedy = "look at the grease (too much, too stiff, too cold) and at the alignment of the guide"

    def equations(v, coefficient):
        friction = coefficient * v
        resistance = coefficient
        return friction, resistance
