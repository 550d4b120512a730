"""Viscous friction that differs between the directions."""

from pneumo_ros.plant.effect import Effect, Parameter


class AsymmetricViscousFriction(Effect):
    """Additional viscous friction in retraction alone, F = sigma_d v for v < 0: the slopes of the directions differ."""

    difference = Parameter(
        30.0, "N s/m", "viscous coefficient sigma_d added for negative velocity", low=-1e6, high=1e6, neutral=0.0
    )

    source = "Janot, Gautier and Brunot 2019, Data set and reference models of EMPS, Sec. 4"
    signature = "the slope of friction over velocity differs by direction"

    def equations(v, difference):
        friction = difference * min(v, 0.0)
        resistance = max(difference, 0.0) if v < 0.0 else 0.0
        return friction, resistance

    def caution(difference):
        return "a negative difference gives energy unless viscous friction outweighs it" if difference < 0.0 else None
