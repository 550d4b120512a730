"""Friction that changes along the stroke."""

from pneumo_ros.plant.effect import Effect, Parameter


def coefficient(knot: int) -> Parameter:
    """Specification of the profile's coefficient at a knot; by default there is a tight spot in the middle."""
    meaning = f"coefficient of the profile at {knot}/24 of the stroke"
    return Parameter(0.1 if knot == 12 else 0.0, "1", meaning, low=-0.9, high=10.0, neutral=0.0)


def bump(u: float) -> float:
    """Six times the cubic B-spline of unit spacing, centred at 0."""
    outer, inner = max(2.0 - abs(u), 0.0), max(1.0 - abs(u), 0.0)
    return outer * outer * outer - 4.0 * inner * inner * inner


class PositionDependentFriction(Effect):
    """Dry friction times 1 + profile(y), a cubic spline with 25 knots evenly over the stroke: tight and loose spots.

    Beyond either end the spline goes on with the coefficient of its last knot.
    """

    (
        knot_00, knot_01, knot_02, knot_03, knot_04, knot_05, knot_06, knot_07, knot_08, knot_09, knot_10, knot_11,
        knot_12, knot_13, knot_14, knot_15, knot_16, knot_17, knot_18, knot_19, knot_20, knot_21, knot_22, knot_23,
        knot_24,
    ) = map(coefficient, range(25))  # fmt: skip

    source = (
        "Armstrong-Helouvry 1991, Control of Machines with Friction (friction over position); de Boor 1978, "
        "A Practical Guide to Splines"
    )
    signature = "friction follows position, flips with velocity and repeats every stroke"

    def equations(
        y, stroke,
        knot_00, knot_01, knot_02, knot_03, knot_04, knot_05, knot_06, knot_07, knot_08, knot_09, knot_10, knot_11,
        knot_12, knot_13, knot_14, knot_15, knot_16, knot_17, knot_18, knot_19, knot_20, knot_21, knot_22, knot_23,
        knot_24,
    ):  # fmt: skip
        x = 24.0 * min(max(y / stroke + 0.5, 0.0), 1.0)
        profile = (
            knot_00 * (bump(x + 1.0) + bump(x)) + knot_01 * bump(x - 1.0) + knot_02 * bump(x - 2.0)
            + knot_03 * bump(x - 3.0) + knot_04 * bump(x - 4.0) + knot_05 * bump(x - 5.0) + knot_06 * bump(x - 6.0)
            + knot_07 * bump(x - 7.0) + knot_08 * bump(x - 8.0) + knot_09 * bump(x - 9.0) + knot_10 * bump(x - 10.0)
            + knot_11 * bump(x - 11.0) + knot_12 * bump(x - 12.0) + knot_13 * bump(x - 13.0) + knot_14 * bump(x - 14.0)
            + knot_15 * bump(x - 15.0) + knot_16 * bump(x - 16.0) + knot_17 * bump(x - 17.0) + knot_18 * bump(x - 18.0)
            + knot_19 * bump(x - 19.0) + knot_20 * bump(x - 20.0) + knot_21 * bump(x - 21.0) + knot_22 * bump(x - 22.0)
            + knot_23 * bump(x - 23.0) + knot_24 * (bump(x - 24.0) + bump(x - 25.0))
        )  # fmt: skip
        friction_scale = max(1.0 + profile / 6.0, 0.0)
        return friction_scale
