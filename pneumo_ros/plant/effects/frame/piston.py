"""The moving piston."""

from pneumo_ros.plant.effect import Effect, Parameter, State


class Piston(Effect):
    """Newton's second law of piston, rod and load, Eqs. 1-2: (M + dM) v' = drive - force - friction."""

    mass = Parameter(5.0, "kg", "moving mass M of piston, rod and load", low=1e-3, high=1e4)
    area_a = Parameter(4.1e-4, "m2", "piston area A_a on the side of chamber a", low=1e-6, high=1.0)
    area_b = Parameter(3.0e-4, "m2", "piston area A_b on the side of chamber b, without the rod", low=1e-6, high=1.0)
    stroke = Parameter(2.0, "m", "stroke; y runs from -stroke/2 to stroke/2", low=1e-3, high=20.0)

    y = State("m", "piston position, zero at mid stroke")
    v = State("m/s", "piston velocity")

    source = "Newton's second law; paper Eqs. 1-2"

    def equations(v, drive, force, friction, resistance, added_mass, mass):
        mobility = 1.0 / (mass + added_mass)
        der_y = v
        der_v = mobility * (drive - force - friction)
        rate_v = mobility * resistance
        return der_y, der_v, rate_v
