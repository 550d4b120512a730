"""How finely an added effect can be known at all."""

from pneumo_ros.diagnose.coordinates import coordinates
from pneumo_ros.plant import Model

RULER = 1e-3  # of a value, or of the largest size of its kind: areas, volumes and sensor gains are known no better


def finest(model: Model, name: str) -> float:
    """Least standard deviation of the parameter `name` of an added effect, in its unit."""
    sizes = {c.name: c.unit for c in coordinates(model.library.find(name.partition(".")[0])) if c.is_size}
    kind = [name, *(other for other, unit in sizes.items() if unit == sizes.get(name))]
    return RULER * max(abs(model[n]) for n in kind)
