"""Another shape of the Stribeck curve."""

from pneumo_ros.plant.effect import Effect, Parameter, exp, power


class StribeckShape(Effect):
    """Stribeck decay exp(-|v / v_s|^delta) with a free exponent instead of 2, or the longer tail of a rational one."""

    exponent = Parameter(1.0, "1", "exponent delta of the Stribeck decay", low=0.3, high=4.0, neutral=2.0)

    rational = Parameter(
        0.0, "1", "share that decays as 1 / (1 + |v / v_s|^delta) instead", low=0.0, high=1.0, neutral=0.0
    )

    source = (
        "Bo and Pavelescu 1982, The friction-speed relation and its influence on the critical velocity of stick-slip; "
        "Hess and Soom 1990, Friction at a lubricated line contact operating at oscillating sliding velocities"
    )
    signature = "shows only below about five Stribeck velocities"
    remedy = "nothing to repair: it is a property of seals and grease; keep it in the model"

    def equations(slip, stribeck_velocity, exponent, rational):
        speed = power(abs(slip) / stribeck_velocity, exponent)
        stribeck = (1.0 - rational) * exp(-speed) + rational / (1.0 + speed)
        return stribeck
