"""Friction that changes along the stroke."""

from pneumo_ros.plant.effect import Effect, Parameter


def coefficient(knot: int) -> Parameter:
    """Specification of the profile's coefficient at a knot; by default there is a tight spot in the middle."""
    meaning = f"coefficient of the profile at {knot}/24 of the stroke"
    return Parameter(0.1 if knot == 12 else 0.0, "1", meaning, low=-0.9, high=10.0, neutral=0.0)


def bump(distance: float) -> float:
    """(1 - distance^2)^3 within 1, and 0 beyond: nearly a Gaussian of deviation 1/3."""
    inside = max(1.0 - distance * distance, 0.0)
    return inside * inside * inside


def cubic(u: float, before: float, left: float, right: float, after: float) -> float:
    """Six times the cubic spline at a share u in [0, 1] of the way from a knot to the next, from four coefficients."""
    v = 1.0 - u
    near, far = u * u * (3.0 * u - 6.0) + 4.0, v * v * (3.0 * v - 6.0) + 4.0
    return before * v * v * v + left * near + right * far + after * u * u * u


class PositionDependentFriction(Effect):
    """Dry friction times 1 + profile(y): one tight or loose spot, or a cubic spline with 25 knots over the stroke.

    The spot is h (1 - ((x - c) / w)^2)^3 within w of its centre c, x = y / stroke. Beyond either end the spline goes on
    with the coefficient of its last knot.
    """

    (
        knot_00, knot_01, knot_02, knot_03, knot_04, knot_05, knot_06, knot_07, knot_08, knot_09, knot_10, knot_11,
        knot_12, knot_13, knot_14, knot_15, knot_16, knot_17, knot_18, knot_19, knot_20, knot_21, knot_22, knot_23,
        knot_24,
    ) = map(coefficient, range(25))  # fmt: skip
    spot_height = Parameter(
        0.0, "1", "friction that a spot adds at its centre, as a share", low=-1.0, high=10.0, neutral=0.0, usual=0.3
    )
    spot_centre = Parameter(
        0.0, "1", "centre of the spot from mid stroke, as a share of the stroke", low=-0.5, high=0.5,
        optional=True, usual=0.05, shapes="spot_height",
    )  # fmt: skip
    spot_width = Parameter(
        0.08, "1", "half the width of the spot, as a share of the stroke", low=0.002, high=1.0,
        optional=True, shapes="spot_height",
    )  # fmt: skip

    source = (
        "Armstrong-Helouvry 1991, Control of Machines with Friction (friction over position); de Boor 1978, "
        "A Practical Guide to Splines"
    )
    signature = "friction follows position, flips with velocity and repeats every stroke"
    remedy = "look along the stroke where friction is high: bent rod, worn or dirty guide, misalignment"

    def equations(
        y, stroke,
        knot_00, knot_01, knot_02, knot_03, knot_04, knot_05, knot_06, knot_07, knot_08, knot_09, knot_10, knot_11,
        knot_12, knot_13, knot_14, knot_15, knot_16, knot_17, knot_18, knot_19, knot_20, knot_21, knot_22, knot_23,
        knot_24, spot_height, spot_centre, spot_width,
    ):  # fmt: skip
        x = min(24.0 * min(max(y / stroke + 0.5, 0.0), 1.0), 23.999999999)
        # The coefficients around x by the binary digits of the knot below it: selects, which vectorise over lanes.
        sixteen = x >= 16.0
        x = x - 16.0 if sixteen else x
        a00 = knot_15 if sixteen else knot_00
        a01 = knot_16 if sixteen else knot_00
        a02 = knot_17 if sixteen else knot_01
        a03 = knot_18 if sixteen else knot_02
        a04 = knot_19 if sixteen else knot_03
        a05 = knot_20 if sixteen else knot_04
        a06 = knot_21 if sixteen else knot_05
        a07 = knot_22 if sixteen else knot_06
        a08 = knot_23 if sixteen else knot_07
        a09 = knot_24 if sixteen else knot_08
        a10 = knot_24 if sixteen else knot_09
        eight = x >= 8.0
        x = x - 8.0 if eight else x
        b00 = a08 if eight else a00
        b01 = a09 if eight else a01
        b02 = a10 if eight else a02
        b03 = knot_10 if eight else a03
        b04 = knot_11 if eight else a04
        b05 = knot_12 if eight else a05
        b06 = knot_13 if eight else a06
        b07 = knot_14 if eight else a07
        b08 = knot_15 if eight else a08
        b09 = knot_16 if eight else a09
        b10 = knot_17 if eight else a10
        four = x >= 4.0
        x = x - 4.0 if four else x
        c0 = b04 if four else b00
        c1 = b05 if four else b01
        c2 = b06 if four else b02
        c3 = b07 if four else b03
        c4 = b08 if four else b04
        c5 = b09 if four else b05
        c6 = b10 if four else b06
        two = x >= 2.0
        x = x - 2.0 if two else x
        d0 = c2 if two else c0
        d1 = c3 if two else c1
        d2 = c4 if two else c2
        d3 = c5 if two else c3
        d4 = c6 if two else c4
        one = x >= 1.0
        x = x - 1.0 if one else x
        e0 = d1 if one else d0
        e1 = d2 if one else d1
        e2 = d3 if one else d2
        e3 = d4 if one else d3
        spot = spot_height * bump((y / stroke - spot_centre) / spot_width)
        friction_scale = max(1.0 + spot + cubic(x, e0, e1, e2, e3) / 6.0, 0.0)
        return friction_scale
