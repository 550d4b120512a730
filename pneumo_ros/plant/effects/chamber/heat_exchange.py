"""Heat between gas and wall."""

from pneumo_ros.plant.effect import Effect, Parameter, State

COLDEST = 50.0  # K, below which air is no gas


class HeatExchange(Effect):
    """Gas temperature T + theta relaxes to the wall's at a rate 1/tau and takes the pressure along.

    theta' = T_g ((gamma R T q - (gamma - 1) p V') / (p V) - q R T_g / (p V)) - theta / tau with T_g = T + theta, from
    the balances of mass and energy; the wall takes Q = -p V theta / ((gamma - 1) T_g tau).
    """

    rate = Parameter(2.0, "1/s", "rate 1/tau at which the gas takes the wall's temperature", 0.0, 1e3, neutral=0.0)

    theta_a = State("K", "temperature of the gas in chamber a above the wall's")
    theta_b = State("K", "temperature of the gas in chamber b above the wall's")

    source = "Carneiro and de Almeida 2006, Reduced-order thermodynamic models for servo-pneumatic actuator chambers"
    signature = "pressure relaxes after the valve closes; transients change, steady speed does not"

    def equations(
        y, v, p_a, p_b, theta_a, theta_b, port_flow_a, port_flow_b, flow_a, flow_b, added_volume_a, added_volume_b,
        area_a, area_b, volume_a, volume_b, gas_constant, temperature, heat_capacity_ratio, rate,
    ):  # fmt: skip
        gamma, R, T = heat_capacity_ratio, gas_constant, temperature
        pV_a = p_a * (volume_a + added_volume_a + area_a * y)
        pV_b = p_b * (volume_b + added_volume_b - area_b * y)
        T_a, T_b = max(T + theta_a, COLDEST), max(T + theta_b, COLDEST)
        q_a, q_b = port_flow_a + flow_a, port_flow_b + flow_b
        gain_a = (gamma * R * T * q_a - (gamma - 1.0) * p_a * area_a * v) / pV_a
        gain_b = (gamma * R * T * q_b + (gamma - 1.0) * p_b * area_b * v) / pV_b
        der_theta_a = T_a * (gain_a - q_a * R * T_a / pV_a) - rate * theta_a
        der_theta_b = T_b * (gain_b - q_b * R * T_b / pV_b) - rate * theta_b
        rate_theta_a, rate_theta_b = rate, rate
        excess = max(gamma - 1.0, 1e-9)  # at gamma = 1 heat makes no pressure
        heat_a = -pV_a * theta_a * rate / (excess * T_a)
        heat_b = -pV_b * theta_b * rate / (excess * T_b)
        return heat_a, heat_b, der_theta_a, der_theta_b, rate_theta_a, rate_theta_b
