"""Ten seconds at low opening that show how a rig is wired, before anything about its position is known."""

from pneumo_ros.experiment.programme import Programme, Trial
from pneumo_ros.experiment.room import MARGIN, dead_zone, room_of
from pneumo_ros.experiment.voltages import Ramps
from pneumo_ros.plant import Model

SECONDS = 10.0
BEYOND, MOST = 1.2, 5.0  # V beyond the dead zone, the highest that is tried at first; V, at any time
RISE = 2.5  # s of a ramp: the piston breaks away long before the valve is wide open
SHARE, LEAST = 0.1, 0.012  # of the stroke, and m: the way of each ramp, long enough to tell signs and units apart


def plumbing(model: Model, seconds: float = SECONDS, stronger: float = 1.0) -> Programme:
    """Ramps to and fro about where the piston stands, each a tenth of the stroke.

    They need neither unit nor zero nor sign of any sensor, and no sign of the command. `stronger`: factor of the
    voltage beyond the dead zone. Raises UsageError for a model without valve.
    """
    room = room_of(model)
    way = min(max(SHARE * model["piston.stroke"], LEAST), room["high"] * (1.0 - MARGIN))
    volts = min(max(dead_zone(model)) + BEYOND * stronger, MOST)
    trial = Trial("plumbing", Ramps(round(volts, 3), round(way, 6), RISE), seconds, anywhere=True)
    return Programme("plumbing", model.name, trials=(trial,), blind=True, **room)
