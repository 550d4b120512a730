"""The load of an arm that the rod moves: its mass and its weight depend on where it stands."""

from pneumo_ros.plant.effect import Effect, Parameter


class ArmLoad(Effect):
    """Load of a mechanism with one joint, M(y) y'' + M'(y) v^2 / 2 + E'(y), all along the rod.

    M is the effective mass and E the potential energy of the mechanism, sums of Chebyshev polynomials T_k(x) over the
    stroke, x = 2 y / stroke. A machine file that names a URDF and its joint gets their coefficients from it.
    """

    mass_0 = Parameter(0.0, "kg", "effective mass along the rod, coefficient of T_0", low=0.0, high=1e5)
    mass_1 = Parameter(0.0, "kg", "coefficient of T_1 in the effective mass", low=-1e5, high=1e5, optional=True)
    mass_2 = Parameter(0.0, "kg", "coefficient of T_2 in the effective mass", low=-1e5, high=1e5, optional=True)
    mass_3 = Parameter(0.0, "kg", "coefficient of T_3 in the effective mass", low=-1e5, high=1e5, optional=True)
    mass_4 = Parameter(0.0, "kg", "coefficient of T_4 in the effective mass", low=-1e5, high=1e5, optional=True)
    mass_5 = Parameter(0.0, "kg", "coefficient of T_5 in the effective mass", low=-1e5, high=1e5, optional=True)
    mass_6 = Parameter(0.0, "kg", "coefficient of T_6 in the effective mass", low=-1e5, high=1e5, optional=True)
    mass_7 = Parameter(0.0, "kg", "coefficient of T_7 in the effective mass", low=-1e5, high=1e5, optional=True)
    mass_8 = Parameter(0.0, "kg", "coefficient of T_8 in the effective mass", low=-1e5, high=1e5, optional=True)
    energy_1 = Parameter(0.0, "J", "coefficient of T_1 in the potential energy", low=-1e6, high=1e6, optional=True)
    energy_2 = Parameter(0.0, "J", "coefficient of T_2 in the potential energy", low=-1e6, high=1e6, optional=True)
    energy_3 = Parameter(0.0, "J", "coefficient of T_3 in the potential energy", low=-1e6, high=1e6, optional=True)
    energy_4 = Parameter(0.0, "J", "coefficient of T_4 in the potential energy", low=-1e6, high=1e6, optional=True)
    energy_5 = Parameter(0.0, "J", "coefficient of T_5 in the potential energy", low=-1e6, high=1e6, optional=True)
    energy_6 = Parameter(0.0, "J", "coefficient of T_6 in the potential energy", low=-1e6, high=1e6, optional=True)
    energy_7 = Parameter(0.0, "J", "coefficient of T_7 in the potential energy", low=-1e6, high=1e6, optional=True)
    energy_8 = Parameter(0.0, "J", "coefficient of T_8 in the potential energy", low=-1e6, high=1e6, optional=True)

    source = "Lagrange's equation for one coordinate; effective mass 1/(J M^-1 J^T), Khatib 1987, eq. 51"
    signature = "mass and load change along the stroke, as the arm's geometry says"
    remedy = "nothing to repair: an arm weighs what its URDF says; keep it in the model"
    # with the URDF, its joint that the rod moves, and the links at both ends of the cylinder
    entered = "arm_load: {urdf: arm.urdf, joint: shoulder, between: [base_pin, rod_pin], length: 0.52}"

    def equations(
        y, v, stroke,
        mass_0, mass_1, mass_2, mass_3, mass_4, mass_5, mass_6, mass_7, mass_8,
        energy_1, energy_2, energy_3, energy_4, energy_5, energy_6, energy_7, energy_8,
    ):  # fmt: skip
        x = min(max(2.0 * y / stroke, -1.1), 1.1)  # beyond the stops, the polynomials mean nothing
        two_x = 2.0 * x
        # T_k, and U_k of the second kind: T_k' = k U_(k-1)
        t_2 = two_x * x - 1.0
        t_3 = two_x * t_2 - x
        t_4 = two_x * t_3 - t_2
        t_5 = two_x * t_4 - t_3
        t_6 = two_x * t_5 - t_4
        t_7 = two_x * t_6 - t_5
        t_8 = two_x * t_7 - t_6
        u_2 = two_x * two_x - 1.0
        u_3 = two_x * u_2 - two_x
        u_4 = two_x * u_3 - u_2
        u_5 = two_x * u_4 - u_3
        u_6 = two_x * u_5 - u_4
        u_7 = two_x * u_6 - u_5
        mass = (
            mass_0
            + mass_1 * x
            + mass_2 * t_2
            + mass_3 * t_3
            + mass_4 * t_4
            + mass_5 * t_5
            + mass_6 * t_6
            + mass_7 * t_7
            + mass_8 * t_8
        )
        steeper = (
            mass_1
            + 2.0 * mass_2 * two_x
            + 3.0 * mass_3 * u_2
            + 4.0 * mass_4 * u_3
            + 5.0 * mass_5 * u_4
            + 6.0 * mass_6 * u_5
            + 7.0 * mass_7 * u_6
            + 8.0 * mass_8 * u_7
        )
        uphill = (
            energy_1
            + 2.0 * energy_2 * two_x
            + 3.0 * energy_3 * u_2
            + 4.0 * energy_4 * u_3
            + 5.0 * energy_5 * u_4
            + 6.0 * energy_6 * u_5
            + 7.0 * energy_7 * u_6
            + 8.0 * energy_8 * u_7
        )
        added_mass = max(mass, 0.0)
        force = (2.0 / stroke) * (0.5 * steeper * v * v + uphill)
        return added_mass, force
