"""The air that one axis of a machine draws from the supply that all share; machines of one axis have no use for it."""

from pneumo_ros.plant.effect import Effect, State


class DrawnAir(Effect):
    """Mass of air drawn from the supply, m' = max(q_a, 0) + max(q_b, 0), of which `supply_pressure_droop` drops."""

    drawn_mass = State("kg", "air drawn from the supply since the start")

    source = "balance of mass"

    def equations(valve_flow_a, valve_flow_b):
        der_drawn_mass = max(valve_flow_a, 0.0) + max(valve_flow_b, 0.0)
        return der_drawn_mass
