"""Friction that differs between the directions."""

from pneumo_ros.plant.effect import Effect, Parameter


class AsymmetricFriction(Effect):
    """Coulomb and static friction (1 + r) times larger in retraction than in extension: lip seals are asymmetric."""

    ratio = Parameter(0.1, "1", "excess r of friction for negative velocity", low=-0.9, high=5.0, neutral=0.0)

    source = (
        "Canudas de Wit et al. 1995 (g may differ by direction); Andrighetto, Valdiero and Carlotto 2006, Study of the "
        "friction behavior in industrial pneumatic actuators (maps of both directions)"
    )
    signature = "two friction levels and a jump at reversal; unlike a load, it vanishes at rest"

    def equations(v, ratio):
        friction_scale = 1.0 + (ratio if v < 0.0 else 0.0)
        return friction_scale
