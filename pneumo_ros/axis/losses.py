"""How many messages never arrived, from the numbers that publishers give them."""

from collections.abc import Hashable


class LossCount:
    """Counts what is missing between the numbers that each publisher gives its messages."""

    def __init__(self) -> None:
        self.lost = 0
        self._last: dict[Hashable, int] = {}

    def note(self, publisher: Hashable, number: int | None, *, began_later: bool = False) -> None:
        """A message with `number` arrived from `publisher`; None where the middleware does not number messages.

        `began_later`: the publisher appeared after the counting began, so that all its messages should have arrived.
        """
        if number is None:
            return
        if began_later:
            self._last.setdefault(publisher, 0)
        last = self._last.get(publisher)
        if last is None or number > last:
            self._last[publisher] = number
            self.lost += 0 if last is None else number - last - 1
        elif number != last:  # it was counted as lost when a later one overtook it
            self.lost -= 1
