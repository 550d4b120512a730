"""Friction that differs between the directions."""

from pneumo_ros.plant.effect import Effect, Parameter


class AsymmetricFriction(Effect):
    """Coulomb and static friction (1 + r) times larger in retraction than in extension: lip seals are asymmetric.

    Static friction may differ by another factor: (1 + r) (1 + s), where the maps of both directions differ in shape.
    """

    ratio = Parameter(0.1, "1", "excess r of friction for negative velocity", low=-0.9, high=5.0, neutral=0.0)

    static_ratio = Parameter(
        0.0, "1", "further excess s of static friction alone for negative velocity", low=-0.9, high=5.0, neutral=0.0
    )

    source = (
        "Canudas de Wit et al. 1995 (g may differ by direction); Andrighetto, Valdiero and Carlotto 2006, Study of the "
        "friction behavior in industrial pneumatic actuators (maps of both directions)"
    )
    signature = "two friction levels and a jump at reversal; unlike a load, it vanishes at rest"
    remedy = "look at the rod seal and the wiper, and at the alignment of rod and load"

    def equations(v, ratio, static_ratio):
        friction_scale = 1.0 + (ratio if v < 0.0 else 0.0)
        static_scale = 1.0 + (static_ratio if v < 0.0 else 0.0)
        return friction_scale, static_scale
