"""A valve whose null is not at zero volts."""

from pneumo_ros.plant.effect import Effect, Parameter


class ValveNullOffset(Effect):
    """Offset voltage U_0 of the valve's null."""

    offset = Parameter(0.1, "V", "voltage U_0 added to the command", low=-10.0, high=10.0, neutral=0.0)

    source = "ISO 10770-1, null bias (there of hydraulic valves)"
    signature = "left and right dead zones differ; creep at zero volts"
    remedy = "set the null of the valve, or the offset of the command in the controller"

    def equations(offset):
        voltage_offset = offset
        return voltage_offset
