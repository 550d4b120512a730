"""How long a piston has stood still, and how often it has stopped on the way to one goal."""

STUCK = 0.05  # s without motion after which the piston counts as stuck
FREE = 6  # stops at wrong places before tolerances widen; a detour (see `Approach`) makes two
WIDEST = 4  # times that a tolerance may double


class Stops:
    """Counts stops until the goal moves. A law that widens its tolerance by `patience` does not hunt for ever."""

    def __init__(self) -> None:
        """Start without stops."""
        self.still, self.count = 0.0, 0
        self._anchor, self._goal = 0.0, 0.0

    @property
    def stuck(self) -> bool:
        """Whether the piston has stood long enough to have stopped."""
        return self.still >= STUCK

    @property
    def patience(self) -> float:
        """Factor on a tolerance: 1 at first, doubled by each stop beyond the FREE ones."""
        return float(2.0 ** min(max(self.count - FREE, 0), WIDEST))

    def watch(self, goal: float, position: float, span: float, arrived: bool, dt: float) -> None:
        """Take a `position` [m]; motion below `span` [m] is ignored, and a stop when `arrived` is not counted."""
        before, self.still = self.still, self.still + dt
        self.count += before < STUCK <= self.still and not arrived
        if abs(position - self._anchor) > span:
            self._anchor, self.still = position, 0.0
        if goal != self._goal:
            self._goal, self.count = goal, 0
