"""The experiment to do next, in a sentence."""

from collections.abc import Sequence

from pneumo_ros.experiment.separate import CLEAR, NOTHING, PRIOR, Separation


def best(ranked: Sequence[Separation], by_hand: bool = True) -> Separation | None:
    """The most informative experiment, of all or of those without preparation by hand; None if none is informative."""
    found = (one for one in ranked if not one.refused and (by_hand or not one.offer.prepare))
    return next((one for one in found if one.separation >= NOTHING), None)


def suggestion(ranked: Sequence[Separation], effect_a: str, effect_b: str, model: str = "axis") -> str:
    """One plain sentence: which experiment distinguishes the two effects, why, and what to type.

    `ranked` as `separate` gives it; `model` is what --model takes.
    """
    chosen = best(ranked)
    if chosen is None:
        most = max((one.separation for one in ranked), default=0.0)
        return (
            f"No experiment on the menu distinguishes {effect_a} from {effect_b} on this machine: "
            f"at most {most:.1f} noise deviations are expected, and fewer than {NOTHING:g} decide nothing."
        )
    first = f"{chosen.offer.prepare}: " if chosen.offer.prepare else ""
    more = ", and repeating it adds little" if chosen.where == PRIOR else ": repeat it"
    weak = "" if chosen.separation >= CLEAR else f", which is little{more}"
    return (
        f"To distinguish {effect_a} from {effect_b}, {first}"
        f"pneumo experiment {chosen.offer.experiment} --model {model} "
        f"({chosen.separation:.1f} noise deviations expected{weak}; it shows in: {chosen.where})."
    )
