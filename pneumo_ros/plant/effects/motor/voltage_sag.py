"""A supply voltage that falls with the current drawn."""

from pneumo_ros.plant.effect import Effect, Parameter


class VoltageSag(Effect):
    """The source has a resistance: V = V_0 - r duty (duty V - e v), which solved for V_0 - V is

    r duty (duty V_0 - e v) / (1 + r duty^2). The driver draws duty times the current of the motor. r is the source's
    resistance over the motor's: a motor that stalls at full duty has V_0 / (1 + r).
    """

    ratio = Parameter(0.1, "1", "resistance r of the source over that of the motor", low=0.0, high=1.0, neutral=0.0)

    source = "Ohm's law of the source, and the balance of power of a driver that chops the voltage"
    signature = "the drive falls behind at high duty, most where the motor stalls"
    remedy = "look at source, cable and plugs: a thicker and shorter cable, or a stronger source"

    def equations(v, duty, ratio, dc_motor__back_emf, dc_motor__source_voltage):
        part = ratio * duty
        voltage_drop = part * (duty * dc_motor__source_voltage - dc_motor__back_emf * v) / (1.0 + part * duty)
        return voltage_drop
