"""A spring on the rod."""

from pneumo_ros.plant.effect import Effect, Parameter


class SpringLoad(Effect):
    """Spring between rod and frame, F = k x (1 + p |x| + h x^2) with x = y - y_0: a hose or a balancing spring.

    Linear with p = h = 0; a coil that closes turn by turn is progressive, a hose that is pulled straight hardens.
    p |x| + h x^2 is limited to -1/2 to 9: no spring changes more.
    """

    stiffness = Parameter(100.0, "N/m", "spring stiffness k where it is slack", low=-1e4, high=1e4, neutral=0.0)
    rest_position = Parameter(0.0, "m", "position y_0 at which the spring is slack", low=-10.0, high=10.0)
    hardening = Parameter(0.0, "1/m2", "relative increase h of the stiffness", low=-100.0, high=100.0)
    progression = Parameter(0.0, "1/m", "relative increase p of the stiffness", low=-20.0, high=20.0)

    source = "Hooke's law; with a cubic term, Duffing 1918; progressive as by EN 13906-1, Cylindrical helical springs"
    signature = "a force that grows with position and does not flip with the direction of motion"
    remedy = "look for a spring, a hose or a cable that pulls more the farther the piston goes"

    def equations(y, stiffness, rest_position, hardening, progression):
        x = y - rest_position
        growth = min(max((progression + hardening * abs(x)) * abs(x), -0.5), 9.0)
        force = stiffness * x * (1.0 + growth)
        return force
