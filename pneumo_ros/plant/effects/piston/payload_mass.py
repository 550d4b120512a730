"""Mass that the model lacks."""

from pneumo_ros.plant.effect import Effect, Parameter


class PayloadMass(Effect):
    """Additional mass that moves with the piston."""

    mass_added = Parameter(5.0, "kg", "additional moving mass", low=0.0, high=1e4, neutral=0.0)

    source = "Newton's second law"
    signature = "residual force follows acceleration"
    remedy = "weigh what is fixed to the rod and enter its mass"

    def equations(mass_added):
        added_mass = mass_added
        return added_mass
