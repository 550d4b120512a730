"""Tubes between valve and cylinder."""

from pneumo_ros.plant.effect import Effect, Parameter, State, exp

RESOLVED = 2e-3  # s: shorter delays use a share of this one, which is nearly equal without shorter steps
# Pade approximant of exp(-s), numerator 1 - s / 4, denominator (1 + s / P) (1 + (D s + s^2) / C)
P, C, D = 2.6258168189584645, 9.140013052974366, 3.374183181041531


class LineDelay(Effect):
    """The tubes delay the flow, and their friction reduces it: q(t) = exp(-p_l / p) q_valve(t - tau).

    tau is the length of a tube over the speed of sound, about 3 ms/m; p_l = R_t R T tau / 2 with the tube's resistance
    per length and area R_t, 32 mu / D^2 if laminar. The delay is its (1, 3) Pade approximation, which passes no jump,
    conserves mass and has the exact mean delay.
    """

    delay = Parameter(6e-3, "s", "delay tau of either line", low=0.0, high=0.2, neutral=0.0, role="delay")
    loss_pressure = Parameter(0.0, "Pa", "pressure p_l at which a line lets 1/e through", 0.0, 1e5, neutral=0.0)

    line_a_1 = State("kg/s", "flow of line a after the first lag")
    line_a_2 = State("kg/s", "flow of line a after the second and third")
    line_a_3 = State("kg/s", "its change within the delay")
    line_b_1 = State("kg/s", "flow of line b after the first lag")
    line_b_2 = State("kg/s", "flow of line b after the second and third")
    line_b_3 = State("kg/s", "its change within the delay")

    source = "Richer and Hurmuzlu 2000, A high performance pneumatic force actuator system, Part I (connecting tubes)"
    signature = "flow is a delayed copy of the valve's flow"
    remedy = "shorten the hoses, or mount the valve nearer to the cylinder"

    def equations(
        valve_flow_a, valve_flow_b, p_a, p_b, p_atm, line_a_1, line_a_2, line_a_3, line_b_1, line_b_2, line_b_3,
        delay, loss_pressure,
    ):  # fmt: skip
        pace, share = 1.0 / max(delay, RESOLVED), min(delay / RESOLVED, 1.0)
        sent_a = valve_flow_a * exp(-loss_pressure / max(p_a, 0.1 * p_atm))
        sent_b = valve_flow_b * exp(-loss_pressure / max(p_b, 0.1 * p_atm))
        der_line_a_1, der_line_b_1 = P * pace * (sent_a - line_a_1), P * pace * (sent_b - line_b_1)
        der_line_a_2, der_line_b_2 = pace * line_a_3, pace * line_b_3
        der_line_a_3 = pace * (C * (line_a_1 - line_a_2) - D * line_a_3)
        der_line_b_3 = pace * (C * (line_b_1 - line_b_2) - D * line_b_3)
        port_flow_a = sent_a + share * (line_a_2 - 0.25 * line_a_3 - sent_a)
        port_flow_b = sent_b + share * (line_b_2 - 0.25 * line_b_3 - sent_b)
        rate_line_a_1, rate_line_b_1, rate_line_a_3, rate_line_b_3 = P * pace, P * pace, D * pace, D * pace
        return (
            port_flow_a, port_flow_b, der_line_a_1, der_line_a_2, der_line_a_3, der_line_b_1, der_line_b_2,
            der_line_b_3, rate_line_a_1, rate_line_a_3, rate_line_b_1, rate_line_b_3,
        )  # fmt: skip
