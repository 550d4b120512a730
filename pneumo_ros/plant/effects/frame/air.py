"""The gas, its supply and the atmosphere."""

from pneumo_ros.plant.effect import Effect, Parameter


class Air(Effect):
    """Ideal gas of constant heat capacities, its supply and the atmosphere: constants that the equations share."""

    supply_pressure = Parameter(7e5, "Pa", "supply pressure p_s, absolute", low=1e4, high=5e6)
    atmospheric_pressure = Parameter(1e5, "Pa", "pressure of the atmosphere p_atm, absolute", low=1e4, high=2e5)
    gas_constant = Parameter(287.0, "J/(kg K)", "specific gas constant R", low=10.0, high=5000.0)
    temperature = Parameter(293.0, "K", "temperature T of the gas", low=150.0, high=600.0)
    heat_capacity_ratio = Parameter(1.4, "1", "ratio gamma of the specific heats", low=1.0, high=1.7)

    source = "paper Table 1"
