"""The signal at which a machine's valve is closed: 0 V, or where its machine file says it is."""

from pneumo_ros.plant.model import Model

OFFSET = "valve_null_offset.offset"
LARGEST = 10.0  # V, that valve amplifiers of this kind take


def closed_signal(model: Model) -> float:
    """The command [V] that closes the valve: 5 V for a valve of 0 to 10 V, by its `valve_null_offset`."""
    return -model.parameters.get(OFFSET, 0.0) + 0.0  # never -0


def centred(model: Model) -> Model:
    """The same machine with commands counted from the closed signal."""
    return model.with_parameters({OFFSET: 0.0}) if closed_signal(model) else model
