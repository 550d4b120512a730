"""Static friction that grows while the piston rests."""

from pneumo_ros.plant.effect import Effect, Parameter, State


class DwellTimeBreakaway(Effect):
    """Static friction rises with time at rest and saturates; sliding wipes it out: w' = (1 - w) / tau - w |v| / d."""

    rise = Parameter(20.0, "N", "largest additional static friction", low=0.0, high=1e5, neutral=0.0)
    time_constant = Parameter(1.0, "s", "time constant tau of rest", low=1e-3, high=1e4)
    distance = Parameter(1e-4, "m", "sliding distance d that wipes it out", low=1e-6, high=0.1)

    w = State("1", "share of the rise that rest has built up")

    source = "Rabinowicz 1958, The intrinsic variables affecting the stick-slip process; Ruina 1983"
    signature = "the first breakaway after a pause is higher"

    def equations(v, w, rise, time_constant, distance):
        rate_w = 1.0 / time_constant + abs(v) / distance
        der_w = 1.0 / time_constant - rate_w * w
        static_rise = rise * w
        return static_rise, der_w, rate_w
