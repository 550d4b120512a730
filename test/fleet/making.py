"""Recordings of a small fleet of machines with known friction, identified in seconds."""

from pathlib import Path

from ros.campaign_bags import record_campaign

from pneumo_ros.plant import load_model

AXIS = load_model("axis")
DAY = 86_400_000_000_000  # ns


def record_fleet(folder: Path, coulomb: dict[str, list[float]]) -> Path:
    """A folder for each machine, and a campaign for each value of its Coulomb friction [N], a week apart."""
    for machine, frictions in coulomb.items():
        for week, friction in enumerate(frictions):
            place = folder / machine / f"week_{week}"
            place.mkdir(parents=True)
            worn = AXIS.with_parameters({"lugre_friction.coulomb_friction": friction})
            record_campaign(place, worn, (0.83, 3.0), 2.5, start_ns=1_700_000_000_000_000_000 + 7 * week * DAY)
    return folder
