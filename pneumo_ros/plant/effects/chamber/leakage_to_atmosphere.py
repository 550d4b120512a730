"""Air lost to the outside."""

from pneumo_ros.plant.effect import Effect, Parameter


class LeakageToAtmosphere(Effect):
    """Laminar leakage of each chamber to the atmosphere, q = -G (p - p_atm)."""

    conductance_a = Parameter(1e-10, "kg/(s Pa)", "leakage conductance of chamber a", low=0.0, high=1e-6, neutral=0.0)
    conductance_b = Parameter(1e-10, "kg/(s Pa)", "leakage conductance of chamber b", low=0.0, high=1e-6, neutral=0.0)

    source = "Beater 2007, Pneumatic Drives (leakage)"
    signature = "one chamber alone loses air, always outward"
    remedy = "find the leak at fittings, hose and rod seal of this chamber with soapy water; tighten or replace"

    def equations(p_a, p_b, p_atm, conductance_a, conductance_b):
        flow_a = -conductance_a * (p_a - p_atm)
        flow_b = -conductance_b * (p_b - p_atm)
        return flow_a, flow_b
