"""Play between piston and position sensor."""

from pneumo_ros.plant.effect import Effect, Parameter, State


class Backlash(Effect):
    """The sensor's side follows the piston with a play of width g: a reversal shows only once the play is taken up.

    The state is the piston's place within the play, so that any start position is at rest in its middle.
    """

    gap = Parameter(2e-4, "m", "width g of the play", low=0.0, high=0.1, neutral=0.0)

    y_last = State("m", "piston position at the last step")
    place = State("m", "how far the piston is from the middle of the play")
    begun = State("1", "0 before the first step, 1 after")

    source = "play operator, Nordin and Gutman 2002, Controlling mechanical systems with backlash"
    signature = "measured position waits at reversals, then goes on in parallel"

    def equations(y_measured, place):
        y_measured = y_measured - place
        return y_measured

    def advance(y, y_last, place, begun, gap):
        moved = (y - y_last) if begun > 0.5 else 0.0
        place = min(max(place + moved, -0.5 * gap), 0.5 * gap)
        y_last, begun = y, 1.0
        return y_last, place, begun
