"""The latest part of a motion, and its speed."""

from collections import deque


class Trace:
    """Times [s] and positions [m] of the last `seconds`; the newest point is always kept."""

    def __init__(self, seconds: float) -> None:
        """Forget points older than `seconds` [s]."""
        self._seconds = seconds
        self._points: deque[tuple[float, float]] = deque()

    def add(self, time: float, position: float) -> None:
        """Add a point."""
        self._points.append((time, position))
        while time - self._points[0][0] > self._seconds:
            self._points.popleft()

    @property
    def speed(self) -> float:
        """Mean speed [m/s]; 0 with fewer than two points."""
        if len(self._points) < 2:
            return 0.0
        (begin, there), (end, here) = self._points[0], self._points[-1]
        return (here - there) / (end - begin) if end > begin else 0.0
