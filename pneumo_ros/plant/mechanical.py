"""Parts of a machine: its mechanics, driven by pressures or a force, and its chambers, driven by the position."""

from pneumo_ros.errors import PneumoError
from pneumo_ros.plant.model import Model
from pneumo_ros.plant.reach import written_by

_MECHANICS = frozenset(
    {
        "force", "friction", "added_mass", "friction_scale", "friction_rise", "static_scale", "static_rise", "slip",
        "stribeck", "resistance",
    }
)  # fmt: skip
IMPOSED, ROD = "imposed_motion", "rod_atmospheric_force"


def mechanical(model: Model, by_force: bool = False) -> Model | None:
    """The model without valve and chambers, driven by a force; None where its mechanics need the valve or the gas.

    `by_force`: a force that was measured, which has the atmosphere's on the rod in it already.
    """
    if model.force_driven:
        return model
    kept: list[str] = []
    for name in model.effects:
        if by_force and name == ROD:
            continue
        try:
            Model.build(
                [*kept, name], {}, library=model.library, frame=("piston", "air"), name=model.name, defaults=True
            )
        except PneumoError:
            if moves(model, name):
                return None
            continue
        if moves(model, name):
            kept.append(name)
    values = {k: v for k, v in model.parameters.items() if k.partition(".")[0] in (*kept, "piston", "air")}
    stated = {k: v for k, v in model.uncertainty.items() if k in values}
    return Model.build(
        kept, values, library=model.library, frame=("piston", "air"), name=model.name, uncertainty=stated
    )


def moves(model: Model, name: str) -> bool:
    """Whether an effect acts on the piston or on its position sensor."""
    return not written_by(model.library.find(name)).isdisjoint(_MECHANICS | {"y_measured"})


def pneumatic(model: Model) -> Model:
    """The model without its mechanics: valve and chambers, driven by the measured motion."""
    if model.force_driven or model.imposed:
        return model
    kept = [name for name in model.effects if not written_by(model.library.find(name)) & _MECHANICS]
    return model.with_effects([*kept, IMPOSED])


def whole(model: Model, mechanics: Model) -> Model:
    """`model` with the effects and the values of its `mechanics`, or of its chambers, which were fitted alone.

    A model that is not such a part of `model` is returned as it is.
    """
    chambers = mechanics.imposed and not model.imposed
    if model.force_driven or not (mechanics.force_driven or chambers):
        return mechanics
    further = [name for name in mechanics.effects if name not in (*model.effects, IMPOSED)]
    return model.with_effects([*model.effects, *further], mechanics.parameters)
