"""A supply pressure that falls when air is drawn."""

from pneumo_ros.plant.effect import Effect, Parameter, State


class SupplyPressureDroop(Effect):
    """The supply drops with the flow drawn, through a resistance and a small tank: tau d' = R q - d."""

    resistance_supply = Parameter(5e7, "Pa s/kg", "drop R per mass flow drawn", low=0.0, high=1e9, neutral=0.0)
    time_constant = Parameter(0.3, "s", "time constant tau of the tank", low=5e-3, high=100.0)

    d_s = State("Pa", "drop of the supply pressure")

    source = "balance of mass of a tank behind a resistance, e.g. Beater 2007, Pneumatic Drives"
    signature = "inflow falls during long fillings and recovers after"
    remedy = "look at regulator, filter and supply hose; put a reservoir near the valve"

    def equations(valve_flow_a, valve_flow_b, d_s, resistance_supply, time_constant):
        drawn = max(valve_flow_a, 0.0) + max(valve_flow_b, 0.0)
        rate_d_s = 1.0 / time_constant
        der_d_s = rate_d_s * (resistance_supply * drawn - d_s)
        return der_d_s, rate_d_s

    def outputs(d_s):
        supply_drop = d_s
        return supply_drop
