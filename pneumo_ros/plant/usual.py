"""The usual size of a parameter whose value does not show it, because it is 0 or switches the effect off."""

import math

from pneumo_ros.plant.effect import Effect

RANGE_SHARE = 0.1  # of the allowed range: the usual size where no default gives one


def usual_size(effect: type[Effect], key: str) -> float:
    """Usual distance of a parameter of `effect` from its neutral value (from 0, if it has none), in its unit.

    The stated one, or the distance of its default; where that is 0, the largest of the effect's parameters in the same
    unit, or a tenth of the allowed range (1 if that is infinite), in a machine that turns of the one at every radius.
    Always above 0.
    """
    own = effect.parameters[key]
    if own.usual is not None:
        return abs(own.usual - (own.neutral or 0.0))
    size = abs(own.default - (own.neutral or 0.0))
    if size > 0.0:
        return size
    others = [one for one in effect.parameters.values() if one.neutral is not None and one.unit == own.unit]
    alike = max((abs(one.default - (one.neutral or 0.0)) for one in others), default=0.0)
    span = RANGE_SHARE * (own.high - own.low if own.span is None else own.span)
    return (alike if own.neutral is not None else 0.0) or (span if math.isfinite(span) and span > 0.0 else 1.0)
