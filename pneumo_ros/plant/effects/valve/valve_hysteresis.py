"""A spool that follows the command with play."""

from pneumo_ros.plant.effect import Effect, Parameter, State


class ValveHysteresis(Effect):
    """Play of half width H between command and spool, advanced once per step."""

    half_width = Parameter(0.1, "V", "half width H of the play", low=0.0, high=5.0, neutral=0.0)

    seen = State("V", "voltage that reaches the spool")

    source = "play operator, Visintin 1994, Differential Models of Hysteresis; ISO 10041-1, hysteresis"
    signature = "flow depends on the direction in which the voltage changed last"
    remedy = "clean the valve or replace it; a dither on the command reduces the effect"

    def equations(voltage, seen, half_width):
        voltage = min(max(seen, voltage - half_width), voltage + half_width)
        return voltage

    def advance(voltage):  # the equations have already applied the play
        seen = voltage
        return seen
