"""A load that always pulls the same way."""

from pneumo_ros.plant.effect import Effect, Parameter


class ConstantLoad(Effect):
    """Constant load force, such as gravity M g sin(theta) of an inclined axis; positive against extension."""

    load = Parameter(10.0, "N", "load force F_0, positive against extension", low=-1e5, high=1e5, neutral=0.0)

    source = "Newton's second law"
    signature = "the same force in both directions of motion and at rest"
    remedy = "look at the mounting angle, and at what hangs on the rod; balance it or enter it"

    def equations(load):
        force = load
        return force
