"""Output of `pneumo experiment --separate`: every experiment, and how well it should distinguish two effects."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from pneumo_ros.command.console import columns

if TYPE_CHECKING:
    from pneumo_ros.experiment.separate import Separation
    from pneumo_ros.experiment.whitened import Noise


def separation_text(ranked: "Sequence[Separation]", effects: Sequence[str], noise: "Noise") -> str:
    """The ranked table, and the meaning of its numbers."""
    from pneumo_ros.experiment.separate import CLEAR, NOTHING

    first, second = effects
    rows = [("experiment", "separation", f"if {first}", f"if {second}", "takes", "most in")]
    for one in (one for one in ranked if not one.refused):
        cells = (f"{one.separation:.1f}", f"{one.if_a:.1f}", f"{one.if_b:.1f}", f"{one.duration:.0f} s")
        rows.append((one.offer.name, *cells, one.where if one.separation >= NOTHING else ""))
    lines = [columns(rows, right=(1, 2, 3, 4)), ""]
    lines += [f"{one.offer.name}: {one.offer.prepare}" for one in ranked if one.offer.prepare and not one.refused]
    lines += [f"{one.offer.name} is not offered: in the rehearsal, {one.refused}" for one in ranked if one.refused]
    lines.append(
        f"Misfit in noise deviations when one effect made the recording, and the model with the other was refitted to "
        f"it ({1e6 * noise.position:g} um and {noise.pressure:g} Pa at 1 kHz); separation is the smaller of both. "
        f"Above {CLEAR:g} is clear, below {NOTHING:g} is useless."
    )
    return "\n".join(lines)


def separation_dict(
    ranked: "Sequence[Separation]", effects: Sequence[str], noise: "Noise", sentence: str
) -> dict[str, Any]:
    """The same as data, SI units."""
    return {
        "effects": list(effects),
        "noise": {"position_m": noise.position, "pressure_pa": noise.pressure},
        "suggested_experiment": sentence,
        "experiments": [
            {
                "name": one.offer.name, "experiment": one.offer.experiment, "purpose": one.offer.purpose,
                "prepare": one.offer.prepare, "separation": one.separation,
                "separation_if": dict(zip(effects, (one.if_a, one.if_b), strict=True)),
                "log_likelihood_ratio": one.log_likelihood_ratio, "most_in": one.where,
                "duration_s": one.duration, "refused": one.refused,
            }
            for one in ranked
        ],
    }  # fmt: skip
