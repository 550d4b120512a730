"""Cushions at the ends of the stroke."""

from pneumo_ros.plant.effect import Effect, Parameter


class Cushioning(Effect):
    """Near an end the air leaves only through a throttle: a share of the outflow of the shrinking chamber remains.

    The cushion closes over the first fifth of its length; inflow passes its check valve.
    """

    remaining = Parameter(0.05, "1", "share of the exhaust conductance that the cushion leaves", 1e-4, 1.0, neutral=1.0)
    length = Parameter(0.02, "m", "length of the cushion", low=1e-4, high=1.0)

    source = "Beater 2007, Pneumatic Drives (end-position cushioning)"
    signature = "a spike of back pressure near the ends"
    remedy = "set the cushion screws, or keep the moves clear of the end cushions"

    def equations(y, port_flow_a, port_flow_b, stroke, remaining, length):
        shut_a = min(max((length - 0.5 * stroke - y) / (0.2 * length), 0.0), 1.0)
        shut_b = min(max((length - 0.5 * stroke + y) / (0.2 * length), 0.0), 1.0)
        port_flow_a = port_flow_a * (1.0 - (1.0 - remaining) * shut_a if port_flow_a < 0.0 else 1.0)
        port_flow_b = port_flow_b * (1.0 - (1.0 - remaining) * shut_b if port_flow_b < 0.0 else 1.0)
        return port_flow_a, port_flow_b
