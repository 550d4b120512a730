"""Air past the piston seal."""

from pneumo_ros.plant.effect import Effect, Parameter


class CrossPistonLeakage(Effect):
    """Laminar leakage from chamber a to chamber b, q = G (p_a - p_b)."""

    conductance = Parameter(3e-10, "kg/(s Pa)", "leakage conductance G", low=0.0, high=1e-6, neutral=0.0)

    source = "Richer and Hurmuzlu 2000, A high performance pneumatic force actuator system, Part I (leakage)"
    signature = "equal and opposite flow residuals that follow p_a - p_b"
    remedy = "replace the piston seal; look at the bore for scores"

    def equations(p_a, p_b, conductance):
        flow_b = conductance * (p_a - p_b)
        flow_a = -flow_b
        return flow_a, flow_b
