"""Viscous friction that differs between the directions."""

from pneumo_ros.plant.effect import Effect, Parameter


class AsymmetricViscousFriction(Effect):
    """Viscous friction with a slope for each direction: F = sigma_e v for v > 0, sigma_r v for v < 0."""

    coefficient_extension = Parameter(
        30.0, "N s/m", "slope of friction over velocity in extension sigma_e", low=0.0, high=1e6, neutral=0.0
    )
    coefficient_retraction = Parameter(60.0, "N s/m", "the same in retraction sigma_r", low=0.0, high=1e6, neutral=0.0)

    source = (
        "Janot, Gautier and Brunot 2019, Data set and reference models of EMPS (a machine that has it); Armstrong-"
        "Helouvry, Dupont and Canudas de Wit 1994, A survey of models ... for the control of machines with friction"
    )
    signature = "the slope of friction over velocity differs by direction"
    remedy = "look at lubrication and preload in the direction with more friction"
    contains = ("viscous_friction",)

    def equations(v, coefficient_extension, coefficient_retraction):
        resistance = coefficient_extension if v > 0.0 else coefficient_retraction
        friction = resistance * v
        return friction, resistance
