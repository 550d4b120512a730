"""The load that a load cell at the rod measures."""

from pneumo_ros.plant.effect import Effect, Parameter


class MeasuredLoad(Effect):
    """The load is what a load cell at the rod measures: F = -k F_cell, F_cell the force on the rod, positive as y is.

    For machines whose other end pushes back: a test machine, a second actuator, a branch. k is 1 for a load cell that
    is right, and negative for one that counts the other way round.
    """

    gain = Parameter(
        1.0, "1", "force on the rod over reading k, negative for the other sign", low=-10.0, high=10.0, neutral=0.0
    )

    source = "Newton's second law"
    signature = "the momentum error follows the load cell"
    remedy = "nothing to repair: the load cell tells the load; keep it in the model"

    def equations(load_force, gain):
        force = -gain * load_force
        return force
