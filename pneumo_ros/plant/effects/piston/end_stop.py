"""The ends of the stroke."""

from pneumo_ros.plant.effect import Effect, Parameter


class EndStop(Effect):
    """Compliant end stops: a spring and damper beyond either end of the stroke that push and never pull."""

    stiffness = Parameter(1e6, "N/m", "contact stiffness", low=1e3, high=1e8)
    damping = Parameter(1e3, "N s/m", "contact damping", low=0.0, high=1e6)

    source = "one-sided Kelvin-Voigt contact, as in Modelica Translational MassWithStopAndFriction"
    signature = "velocity drops to zero at a fixed position while the pressures go on"

    def equations(y, v, stroke, stiffness, damping):
        over = max(y - 0.5 * stroke, 0.0)
        under = min(y + 0.5 * stroke, 0.0)
        push_back = max(stiffness * over + damping * v, 0.0) if over > 0.0 else 0.0
        push_out = min(stiffness * under + damping * v, 0.0) if under < 0.0 else 0.0
        force = push_back + push_out
        return force
