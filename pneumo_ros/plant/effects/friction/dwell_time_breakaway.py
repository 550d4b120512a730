"""Static friction that grows while the piston rests."""

from pneumo_ros.plant.effect import Effect, Parameter, State, exp


class DwellTimeBreakaway(Effect):
    """Static friction rises with the age of the contact and saturates: rise (1 - exp(-age / tau)).

    The contact ages at rest and is renewed by sliding over a distance d: age' = 1 - age |v| / d.
    """

    rise = Parameter(20.0, "N", "largest additional static friction", low=0.0, high=1e5, neutral=0.0)
    time_constant = Parameter(1.0, "s", "time constant tau of rest", low=1e-3, high=1e4)
    distance = Parameter(1e-4, "m", "sliding distance d that renews the contact", low=1e-6, high=0.1)

    age = State("s", "how long the contact has rested", initial=10.0)

    source = (
        "Kato, Sato and Matsubayashi 1972, Some considerations on characteristics of static friction of machine tool "
        "slideway (growth); Ruina 1983, Slip instability and state variable friction laws (age)"
    )
    signature = "the first breakaway after a pause is higher"
    remedy = "grease the seals; after a long rest, move once before exact work"

    def equations(v, age, rise, time_constant, distance):
        rate_age = abs(v) / distance
        der_age = 1.0 - rate_age * age
        static_rise = rise * (1.0 - exp(-max(age, 0.0) / time_constant))
        return static_rise, der_age, rate_age
