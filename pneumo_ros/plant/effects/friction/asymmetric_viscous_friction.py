"""Viscous friction that differs between the directions."""

from pneumo_ros.plant.effect import Effect, Parameter


class AsymmetricViscousFriction(Effect):
    """Additional viscous friction in one direction, F = |sigma_d| v: retraction if sigma_d > 0, extension if < 0.

    The slope of retraction exceeds that of extension by sigma_d, and no value gives energy.
    """

    difference = Parameter(
        30.0, "N s/m", "slope of retraction minus slope of extension sigma_d", low=-1e6, high=1e6, neutral=0.0
    )

    source = (
        "Janot, Gautier and Brunot 2019, Data set and reference models of EMPS (a machine that has it); Armstrong-"
        "Helouvry, Dupont and Canudas de Wit 1994, A survey of models ... for the control of machines with friction"
    )
    signature = "the slope of friction over velocity differs by direction"

    def equations(v, difference):
        friction = difference * (min(v, 0.0) if difference > 0.0 else -max(v, 0.0))
        resistance = abs(difference) if v * difference < 0.0 else 0.0
        return friction, resistance
