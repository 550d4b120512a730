"""Heat between gas and wall."""

from pneumo_ros.plant.effect import Effect, Parameter, State, sqrt

SLOWEST = 0.1  # 1/s: below it the effect fades into the base model, whose gas leaves at the wall's temperature
PRESSURE = 4e5  # Pa, of the gas at mid stroke whose rate is given
COLDEST, HOTTEST = 0.1, 10.0  # of the wall's temperature: no gas of a cylinder is beyond, and driven states may be


def film_rate(
    p: float, V: float, middle: float, touched: float, theta: float, T: float, rate: float, film: float
) -> float:
    """Rate [1/s] of a film whose coefficient grows with sqrt(p T_g) over the walls that the gas touches.

    `touched` [1]: these walls over those at mid stroke, where the volume is `middle` [m3].
    """
    warm = min(max(1.0 + theta / T, COLDEST), HOTTEST)
    return rate * (1.0 - film + film * touched * middle / V * warm * sqrt(warm * PRESSURE / p))


def exchange(
    p: float, V: float, work: float, q: float, theta: float, T: float, R: float, gamma: float, rate: float, share: float
) -> tuple[float, float]:
    """Heat into the gas of a chamber [W] and rate of change of theta [K/s]; work = p V'.

    Where the rate is 0 theta acts on nothing, and nothing would bring it back: it fades at the slowest rate.
    """
    T_g = min(max(T + theta, COLDEST * T), HOTTEST * T)
    excess = max(gamma - 1.0, 1e-9)  # at gamma = 1 heat makes no pressure
    kept = min(rate / SLOWEST, 1.0) * R * theta * min(q, 0.0)  # by gas that leaves colder than the base model says
    at_once = share * (work - R * T * q - kept)
    heat = (gamma * kept - p * V * rate * theta / T_g) / excess + at_once
    warming = (gamma * (R * T * q + kept) - (gamma - 1.0) * (work - at_once) - R * T_g * q) / (p * V)
    return heat, T_g * warming - max(rate, SLOWEST) * theta


class HeatExchange(Effect):
    """Full balance of energy: the gas has its own temperature T_g = T + theta, which the wall brings back to T.

    With m = p V / (R T_g), Q = -m c_v theta / tau from the wall and gas that enters at T and leaves at T_g,
    theta' = T_g (gamma R T_in q - (gamma - 1) (p V' - Q) - R T_g q) / (p V). The heat may pass a film along the walls S
    that the gas touches, whose coefficient grows with sqrt(p T_g): Q = -h S theta, so that 1/tau grows with
    S sqrt(p T_g) / m and is the given rate at mid stroke and 4 bar. The actuator says how S grows. A share s of the
    energy of gas and piston may go into the wall at once: with s alone the gas is polytropic with the exponent
    n = gamma - s (gamma - 1).
    """

    rate = Parameter(4.0, "1/s", "rate 1/tau at which the gas takes the wall's temperature", 0.0, 1e3, neutral=0.0)
    share = Parameter(0.0, "1", "share s of the heat that the wall takes at once", low=0.0, high=1.0, neutral=0.0)

    film = Parameter(
        0.0, "1", "share of the rate that follows the film along the walls", low=0.0, high=1.0, optional=True
    )

    theta_a = State("K", "temperature of the gas in chamber a above the wall's")
    theta_b = State("K", "temperature of the gas in chamber b above the wall's")

    source = "Carneiro and de Almeida 2006, Reduced-order thermodynamic models for servo-pneumatic actuator chambers"
    signature = "pressure relaxes after the valve closes; transients change, steady speed does not"
    remedy = "nothing to repair: every cylinder has it; keep it in the model"

    def equations(
        y, v, p_a, p_b, theta_a, theta_b, port_flow_a, port_flow_b, flow_a, flow_b, added_volume_a, added_volume_b,
        touched_a, touched_b, area_a, area_b, volume_a, volume_b, gas_constant, temperature, heat_capacity_ratio,
        rate, share, film,
    ):  # fmt: skip
        T, R, gamma = temperature, gas_constant, heat_capacity_ratio
        V_a = volume_a + added_volume_a + area_a * y
        V_b = volume_b + added_volume_b - area_b * y
        work_a, work_b = p_a * area_a * v, -p_b * area_b * v
        rate_theta_a = film_rate(p_a, V_a, volume_a, touched_a, theta_a, T, rate, film)
        rate_theta_b = film_rate(p_b, V_b, volume_b, touched_b, theta_b, T, rate, film)
        heat_a, der_theta_a = exchange(
            p_a, V_a, work_a, port_flow_a + flow_a, theta_a, T, R, gamma, rate_theta_a, share
        )
        heat_b, der_theta_b = exchange(
            p_b, V_b, work_b, port_flow_b + flow_b, theta_b, T, R, gamma, rate_theta_b, share
        )
        rate_theta_a, rate_theta_b = max(rate_theta_a, SLOWEST), max(rate_theta_b, SLOWEST)
        return heat_a, heat_b, der_theta_a, der_theta_b, rate_theta_a, rate_theta_b
