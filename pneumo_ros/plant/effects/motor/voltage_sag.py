"""A supply voltage that falls with the current drawn."""

from pneumo_ros.plant.effect import Effect, Parameter


class VoltageSag(Effect):
    """The source has a resistance: V = V_0 - s duty F, F = c (duty V - e v), which solved for V_0 - V is

    s c duty (duty V_0 - e v) / (1 + s c duty^2). The driver draws duty times the current of the motor, and s is the
    source's resistance over k_t.
    """

    sag = Parameter(0.3, "V/N", "voltage s that is lost per drive force, at full duty", low=0.0, high=1e4, neutral=0.0)

    source = "Ohm's law of the source, and the balance of power of a driver that chops the voltage"
    signature = "the drive falls behind at high duty, most where the motor stalls"
    remedy = "look at source, cable and plugs: a thicker and shorter cable, or a stronger source"

    def equations(v, duty, sag, dc_motor__force_per_volt, dc_motor__back_emf, dc_motor__source_voltage):
        part = sag * dc_motor__force_per_volt * duty
        voltage_drop = part * (duty * dc_motor__source_voltage - dc_motor__back_emf * v) / (1.0 + part * duty)
        return voltage_drop
