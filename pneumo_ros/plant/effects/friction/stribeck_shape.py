"""Another shape of the Stribeck curve."""

from pneumo_ros.plant.effect import Effect, Parameter, exp, power


class StribeckShape(Effect):
    """Stribeck decay exp(-|v / v_s|^delta) with a free exponent instead of 2."""

    exponent = Parameter(1.0, "1", "exponent delta of the Stribeck decay", low=0.3, high=4.0, neutral=2.0)

    source = (
        "Bo and Pavelescu 1982, The friction-speed relation and its influence on the critical velocity of stick-slip"
    )
    signature = "shows only below about five Stribeck velocities"

    def equations(slip, stribeck_velocity, exponent):
        stribeck = exp(-power(abs(slip) / stribeck_velocity, exponent))
        return stribeck
