"""Friction that grows with the square of velocity."""

from pneumo_ros.plant.effect import Effect, Parameter


class QuadraticDrag(Effect):
    """Quadratic drag C_d v |v|, the empirical memoryless term f(v) of LuGre in Eq. 10; it sets the top speed."""

    coefficient = Parameter(4546.7, "N s2/m2", "drag coefficient C_d", low=0.0, high=1e7, neutral=0.0)

    source = "paper Eq. 10"
    signature = "residual force grows with the square of velocity and changes sign with it"
    remedy = "look for a throttle or a silencer that is clogged; otherwise keep it in the model"

    def equations(v, coefficient):
        resistance = coefficient * abs(v)
        friction = resistance * v
        return friction, resistance
