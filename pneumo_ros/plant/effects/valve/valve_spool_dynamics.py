"""A spool that lags the command."""

from pneumo_ros.plant.effect import Effect, Parameter, State

FASTEST = 1000.0  # rad/s, at which a recording shows only a delay: above half of it the effect fades out


class ValveSpoolDynamics(Effect):
    """Spool position with a second-order lag to the command: x'' = omega^2 (u - x) - 2 zeta omega x'."""

    angular_frequency = Parameter(80.0, "rad/s", "natural angular frequency omega", 5.0, FASTEST, neutral=FASTEST)
    damping_ratio = Parameter(0.7, "1", "damping ratio zeta", low=0.2, high=5.0, role="damping")

    x_s = State("V", "spool position")
    w_s = State("V/s", "spool velocity")

    source = (
        "Sorli, Figliolini and Pastorelli 2004, Dynamic model and experimental investigation of a pneumatic "
        "proportional pressure valve; Beater 2007, Pneumatic Drives"
    )
    signature = "opposite spikes in both flows after each change of voltage"
    remedy = "compare the speed with the data sheet: if it is lower, look at dirt and at the valve's supply voltage"

    def equations(voltage, x_s, w_s, angular_frequency, damping_ratio):
        omega = angular_frequency
        rate_w_s = 2.0 * damping_ratio * omega
        der_x_s = w_s
        der_w_s = omega * omega * (voltage - x_s) - rate_w_s * w_s
        spool = voltage + min(2.0 * (FASTEST - omega) / FASTEST, 1.0) * (x_s - voltage)
        return spool, der_x_s, der_w_s, rate_w_s
