"""A valve that leaks around its null."""

from pneumo_ros.plant.effect import Effect, Parameter, exp


class ValveInternalLeakage(Effect):
    """Leakage from supply to chamber and from chamber to exhaust that fades as the spool opens."""

    conductance = Parameter(3e-11, "kg/(s Pa)", "conductance of either edge at null", low=0.0, high=1e-6, neutral=0.0)
    width = Parameter(0.5, "V", "opening at which it has faded to 1/e", low=0.01, high=10.0)

    source = "Eryilmaz and Wilson 2006, Unified modeling and analysis of a proportional valve (leakage around null)"
    signature = "at zero volts both pressures drift to one level between supply and atmosphere"
    remedy = "clean the valve or replace it; a lapped spool leaks by design, compare with its data sheet"

    def equations(opening, p_a, p_b, p_s, p_atm, conductance, width):
        ratio = opening / width
        G = conductance * exp(-ratio * ratio)
        valve_flow_a = G * ((p_s - p_a) - (p_a - p_atm))
        valve_flow_b = G * ((p_s - p_b) - (p_b - p_atm))
        return valve_flow_a, valve_flow_b
