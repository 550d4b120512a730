"""Volume the model does not know of."""

from pneumo_ros.plant.effect import Effect, Parameter


class DeadVolume(Effect):
    """Additional volume of each chamber: fittings, hoses, ports."""

    volume_added_a = Parameter(3e-5, "m3", "volume added to chamber a", low=-5e-5, high=1.0, neutral=0.0)
    volume_added_b = Parameter(3e-5, "m3", "volume added to chamber b", low=-5e-5, high=1.0, neutral=0.0)

    source = "Beater 2007, Pneumatic Drives, Sec. 5.2"
    signature = "pressures change slower, most near the short end"

    def equations(volume_added_a, volume_added_b):
        added_volume_a, added_volume_b = volume_added_a, volume_added_b
        return added_volume_a, added_volume_b
