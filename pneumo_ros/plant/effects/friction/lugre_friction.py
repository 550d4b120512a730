"""Dynamic friction of the seals."""

from pneumo_ros.plant.effect import Effect, Parameter, State, pi, sin, sqrt


class LugreFriction(Effect):
    """Elasto-plastic LuGre friction, Eqs. 10-14: F = sigma_0 z + sigma_1 z', z' = v - alpha(z, v) sigma_0 |v| z / g(v).

    Below the breakaway deflection z_ba = breakaway_ratio z_max, z_max = g(v) / sigma_0, the contact is purely elastic
    (alpha = 0), hence no creep under small vibrating loads. The plastic term is linear in z, so it is also returned as
    a rate: the integrator solves it exactly at any speed.
    """

    static_friction = Parameter(100.0, "N", "static friction force F_s", low=0.0, high=1e5)
    coulomb_friction = Parameter(70.0, "N", "Coulomb friction force F_c", low=1e-4, high=1e5)
    stribeck_velocity = Parameter(0.01, "m/s", "Stribeck velocity v_s", low=1e-5, high=1.0)
    bristle_stiffness = Parameter(1.4e6, "N/m", "bristle stiffness sigma_0", low=1.0, high=5e7)
    bristle_damping = Parameter(50.0, "N s/m", "bristle damping sigma_1", low=0.0, high=1e5)
    breakaway_ratio = Parameter(
        0.9, "1", "breakaway deflection over largest deflection, z_ba / z_max", low=0.01, high=0.999
    )

    z = State("m", "mean bristle deflection")

    source = (
        "Canudas de Wit et al. 1995; Dupont et al. 2000, Eqs. 4-8; paper Eqs. 10-14 with sgn(y2) in Eq. 5 read as |y2|"
    )
    signature = "sticks until the static friction is reached, falls to the Coulomb level as it slides"
    remedy = "nothing to repair: every seal has it; grease the seals if the static friction has grown"

    def equations(
        v, z, stribeck, friction_scale, friction_rise, static_scale, static_rise,
        static_friction, coulomb_friction, bristle_stiffness, bristle_damping, breakaway_ratio,
    ):  # fmt: skip
        F_c = friction_scale * coulomb_friction + friction_rise
        F_s = friction_scale * static_scale * static_friction + friction_rise + static_rise
        g = max(F_c + (F_s - F_c) * stribeck, 1e-6 * coulomb_friction)
        share = bristle_stiffness * abs(z) / g  # of the largest deflection, |z| / z_max
        rate_z = bristle_stiffness * abs(v) / g  # times alpha:
        if v * z <= 0.0 or share <= breakaway_ratio:
            rate_z = 0.0
        elif share < 1.0:
            rate_z *= 0.5 + 0.5 * sin(pi / (1.0 - breakaway_ratio) * (share - 0.5 * (1.0 + breakaway_ratio)))
        der_z = v - rate_z * z
        friction = bristle_stiffness * z + bristle_damping * der_z
        resistance = bristle_damping
        return friction, resistance, der_z, rate_z

    def outputs(
        stribeck, friction_scale, friction_rise, static_scale, static_rise, static_friction, coulomb_friction,
    ):  # fmt: skip
        slides = friction_scale * coulomb_friction + friction_rise
        holds = friction_scale * static_scale * static_friction + friction_rise + static_rise
        friction_level = slides + (holds - slides) * stribeck
        return friction_level

    invariant = True

    def advance(
        v, z, friction_scale, friction_rise, static_scale, static_rise,
        static_friction, coulomb_friction, bristle_stiffness,
    ):  # fmt: skip
        # |z| <= F_s / sigma_0 is an invariant of the exact equation; one step at high speed may overshoot it. A bristle
        # that unloads keeps its deflection, though the level may have fallen (asymmetric friction at a reversal)
        highest = max(static_scale * static_friction, coulomb_friction)
        level = friction_scale * highest + friction_rise + max(static_rise, 0.0)
        limit = level / bristle_stiffness if v * z >= 0.0 else abs(z)
        z = min(max(z, -limit), limit)
        return z

    def caution(static_friction, coulomb_friction, bristle_damping, quadratic_drag__coefficient):
        # sufficient passivity condition with quadratic drag, Eq. 16 corrected
        rise = static_friction - coulomb_friction
        bound = (
            2.0 * sqrt(quadratic_drag__coefficient * coulomb_friction) * static_friction / rise
            if rise > 0.0
            else float("inf")
        )
        return (
            f"bristle damping {bristle_damping:g} N s/m is above {bound:.0f} N s/m: friction may not be passive"
            if bristle_damping > bound
            else None
        )
