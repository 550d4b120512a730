"""A motor with brushes, behind its gears."""

from pneumo_ros.plant.effect import Effect, Parameter


class DcMotor(Effect):
    """Drive of a motor whose driver passes a share of the voltage, F = c (duty V - e v), without inductance.

    c is k_t / R and e is k_t, both behind the gears; for a rotary machine in N m and rad. Without power the circuit is
    open, and there is neither drive nor brake. A recorded voltage takes the place of V. F adds to what else drives the
    piston; where a recording has a force and the machine file this motor, the motor is believed.
    """

    force_per_volt = Parameter(0.1, "N/V", "drive at rest over voltage c = k_t / R", low=0.0, high=1e4, neutral=0.0)
    back_emf = Parameter(0.3, "V s/m", "back electromotive force e = k_t", low=0.0, high=1e4)
    source_voltage = Parameter(12.0, "V", "voltage V of the source", low=0.1, high=1e3, chosen=True)

    source = "Krishnan 2001, Electric Motor Drives, eq. 2.6 and 2.7, without inductance"
    signature = "the drive falls in proportion to velocity"
    remedy = "nothing to repair: the motor is the machine's own"
    part = True

    def equations(v, drive, duty, driver_voltage, powered, force_per_volt, back_emf):
        drive = drive + powered * force_per_volt * (duty * driver_voltage - back_emf * v)
        resistance = powered * force_per_volt * back_emf
        return drive, resistance
