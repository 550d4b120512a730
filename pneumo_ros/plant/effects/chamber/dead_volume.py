"""Volume that the model lacks."""

from pneumo_ros.plant.effect import Effect, Parameter


class DeadVolume(Effect):
    """Additional volume of each chamber: fittings, hoses, ports. If negative, a tenth of the known volume is kept."""

    volume_added_a = Parameter(3e-5, "m3", "volume added to chamber a", low=-1e-3, high=0.1, neutral=0.0)
    volume_added_b = Parameter(3e-5, "m3", "volume added to chamber b", low=-1e-3, high=0.1, neutral=0.0)

    source = "Richer and Hurmuzlu 2000, A high performance pneumatic force actuator system, Part I (inactive volume)"
    signature = "pressures change slower, most near the short end"
    remedy = "shorten the hoses between valve and cylinder, or measure them and enter their volume"

    def equations(volume_a, volume_b, area_a, area_b, stroke, volume_added_a, volume_added_b):
        added_volume_a = max(volume_added_a, 0.9 * min(0.5 * area_a * stroke - volume_a, 0.0))
        added_volume_b = max(volume_added_b, 0.9 * min(0.5 * area_b * stroke - volume_b, 0.0))
        return added_volume_a, added_volume_b
