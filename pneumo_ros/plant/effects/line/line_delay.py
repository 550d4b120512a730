"""Tubes between valve and cylinder."""

from pneumo_ros.plant.effect import Effect, Parameter, State

SHORTEST = 1e-6  # s: what is shorter, no step can tell from none


class LineDelay(Effect):
    """Flow arrives late through the tubes: three equal first-order lags per line that add to the transport delay.

    The delay of a tube is its length over the speed of sound, about 3 ms/m.
    """

    delay = Parameter(6e-3, "s", "delay of either line", low=0.0, high=0.2, neutral=0.0)
    loss = Parameter(0.0, "1", "share of the flow lost to the tube's resistance", low=0.0, high=0.9, neutral=0.0)

    a_1 = State("kg/s", "flow of line a after the first lag")
    a_2 = State("kg/s", "flow of line a after the second lag")
    a_3 = State("kg/s", "flow of line a at the cylinder")
    b_1 = State("kg/s", "flow of line b after the first lag")
    b_2 = State("kg/s", "flow of line b after the second lag")
    b_3 = State("kg/s", "flow of line b at the cylinder")

    source = "Richer and Hurmuzlu 2000, A high performance pneumatic force actuator system, Part I, Eqs. 21-24"
    signature = "flow is a delayed copy of what the valve gives"

    def equations(valve_flow_a, valve_flow_b, a_1, a_2, a_3, b_1, b_2, b_3, delay, loss):
        rate_a_1 = 3.0 / max(delay, SHORTEST)
        rate_a_2, rate_a_3, rate_b_1, rate_b_2, rate_b_3 = rate_a_1, rate_a_1, rate_a_1, rate_a_1, rate_a_1
        der_a_1, der_b_1 = (
            rate_a_1 * ((1.0 - loss) * valve_flow_a - a_1),
            rate_a_1 * ((1.0 - loss) * valve_flow_b - b_1),
        )
        der_a_2, der_b_2 = rate_a_1 * (a_1 - a_2), rate_a_1 * (b_1 - b_2)
        der_a_3, der_b_3 = rate_a_1 * (a_2 - a_3), rate_a_1 * (b_2 - b_3)
        port_flow_a, port_flow_b = a_3, b_3
        return (
            port_flow_a, port_flow_b, der_a_1, der_a_2, der_a_3, der_b_1, der_b_2, der_b_3,
            rate_a_1, rate_a_2, rate_a_3, rate_b_1, rate_b_2, rate_b_3,
        )  # fmt: skip
