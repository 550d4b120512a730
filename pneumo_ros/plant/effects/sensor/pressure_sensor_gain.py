"""Pressure sensors with a wrong span."""

from pneumo_ros.plant.effect import Effect, Parameter


class PressureSensorGain(Effect):
    """Relative gain error of each pressure sensor, p_m = (1 + k) p."""

    error_a = Parameter(0.01, "1", "gain error k of the sensor of chamber a", low=-0.5, high=0.5, neutral=0.0)
    error_b = Parameter(0.01, "1", "gain error k of the sensor of chamber b", low=-0.5, high=0.5, neutral=0.0)

    source = "IEC 61298-2, span error"
    signature = "an error that grows with pressure"
    remedy = "calibrate the pressure sensor, and compare its range with its settings"

    def equations(p_a_measured, p_b_measured, error_a, error_b):
        p_a_measured = (1.0 + error_a) * p_a_measured
        p_b_measured = (1.0 + error_b) * p_b_measured
        return p_a_measured, p_b_measured
