"""Pressure sensors with an offset."""

from pneumo_ros.plant.effect import Effect, Parameter


class PressureSensorOffset(Effect):
    """Constant offset of each pressure sensor."""

    offset_a = Parameter(5e3, "Pa", "offset of the sensor of chamber a", low=-1e6, high=1e6, neutral=0.0)
    offset_b = Parameter(5e3, "Pa", "offset of the sensor of chamber b", low=-1e6, high=1e6, neutral=0.0)

    source = "IEC 61298-2, zero error"
    signature = "a vented chamber does not read the atmosphere's pressure"
    remedy = "set the zero of the pressure sensor with the chamber vented"

    def equations(p_a_measured, p_b_measured, offset_a, offset_b):
        p_a_measured = p_a_measured + offset_a
        p_b_measured = p_b_measured + offset_b
        return p_a_measured, p_b_measured
