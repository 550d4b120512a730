"""A machine without its valve and chambers: what is left to judge where only pressures or a force were measured."""

from pneumo_ros.errors import PneumoError
from pneumo_ros.plant.model import Model


def mechanical(model: Model) -> Model | None:
    """The model without valve and chambers, driven by a force; None where its mechanics need the valve or the gas."""
    if model.force_driven:
        return model
    kept: list[str] = []
    for name in model.effects:
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
    mechanics = {
        "force", "friction", "added_mass", "friction_scale", "friction_rise", "static_scale", "static_rise", "slip",
        "stribeck", "y_measured", "resistance",
    }  # fmt: skip
    functions = model.library.find(name).functions.values()
    return any(signal in mechanics for function in functions for signal in function.writes)


def whole(model: Model, mechanics: Model) -> Model:
    """`model` with the effects and the values of its `mechanics`, which were fitted or enlarged alone.

    A model that is not such a part of `model` is returned as it is.
    """
    if model.force_driven or not mechanics.force_driven:
        return mechanics
    further = [name for name in mechanics.effects if name not in model.effects]
    return model.with_effects([*model.effects, *further], mechanics.parameters)
