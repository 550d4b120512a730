"""The external force on the rod as it comes in: refused, held until the next one, dropped when it is too old."""

import math

from pneumo_ros.plant import Model

EFFECT, GAIN = "measured_load", "measured_load.gain"
LOAD = "load_force"  # its input, what a load cell reads [N]


def pushed(model: Model) -> Model:
    """`model` with the external force as an input, in the effect `measured_load`; itself where it has that already."""
    return model if EFFECT in model.effects else model.with_effects([*model.effects, EFFECT], {GAIN: 1.0})


class ForceInput:
    """The force [N] on the rod that is in force, positive where it extends; 0 until one has come."""

    def __init__(self) -> None:
        self.timeout = 0.0  # s, simulated; 0: held until the next one
        self.accepted = self.refused = 0
        self.reset()

    def reset(self) -> None:
        """No force; the counts go on."""
        self._force, self._fresh, self._since = 0.0, False, -math.inf

    def accept(self, force: float) -> bool:
        """Take a force [N], which acts from the next sample on; False if it is not finite. Both count."""
        if not math.isfinite(force):
            self.refused += 1
            return False
        self.accepted += 1
        self._force, self._fresh = force, True
        return True

    def at(self, time: float) -> float:
        """The force [N] that acts during the sample that begins at `time` [s]."""
        if self._fresh:
            self._fresh, self._since = False, time
        if self.timeout > 0.0 and time - self._since > self.timeout:
            self._force = 0.0
        return self._force
