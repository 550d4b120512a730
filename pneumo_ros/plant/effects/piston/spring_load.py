"""A spring on the rod."""

from pneumo_ros.plant.effect import Effect, Parameter


class SpringLoad(Effect):
    """Linear spring between rod and frame, F = k (y - y_0), such as a hose or a balancing spring."""

    stiffness = Parameter(100.0, "N/m", "spring stiffness k", low=-1e5, high=1e5, neutral=0.0)
    rest_position = Parameter(0.0, "m", "position y_0 at which the spring is slack", low=-20.0, high=20.0)

    source = "Hooke's law"
    signature = "a force linear in position that does not flip with the direction of motion"

    def equations(y, stiffness, rest_position):
        force = stiffness * (y - rest_position)
        return force
