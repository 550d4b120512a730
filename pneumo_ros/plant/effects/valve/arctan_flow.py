"""The valve's flow characteristic."""

from pneumo_ros.plant.effect import Effect, Parameter, atan


class ArctanFlow(Effect):
    """Mass flow of the 5/3 servo valve, Eqs. 6-9: q = atan(k_u u) beta (pressure difference over the open edge)."""

    filling_coefficient = Parameter(0.69501e-8, "kg/(s Pa)", "flow coefficient beta_fill", low=0.0, high=1e-6)
    exhaust_coefficient = Parameter(0.898105e-8, "kg/(s Pa)", "flow coefficient beta_exhaust", low=0.0, high=1e-6)
    voltage_gain = Parameter(2.0, "1/V", "gain k_u inside the arctangent", low=0.01, high=100.0)

    source = "paper Eqs. 6-9; Endler 2009"
    signature = "steady speed saturates with voltage"
    remedy = "nothing to repair: it is the curve of the valve; enter its figures"

    def equations(
        opening_a, opening_b, share_pa, share_at, share_pb, share_bt, p_a, p_b, p_s, p_atm, filling_coefficient,
        exhaust_coefficient, voltage_gain,
    ):  # fmt: skip
        fill_a, empty_a = share_pa * filling_coefficient * (p_s - p_a), share_at * exhaust_coefficient * (p_a - p_atm)
        fill_b, empty_b = share_pb * filling_coefficient * (p_s - p_b), share_bt * exhaust_coefficient * (p_b - p_atm)
        valve_flow_a = atan(voltage_gain * opening_a) * (fill_a if opening_a >= 0.0 else empty_a)
        valve_flow_b = atan(voltage_gain * opening_b) * (fill_b if opening_b > 0.0 else empty_b)
        return valve_flow_a, valve_flow_b
