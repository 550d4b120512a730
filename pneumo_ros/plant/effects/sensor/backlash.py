"""Play between piston and position sensor."""

from pneumo_ros.plant.effect import Effect, Parameter, State


class Backlash(Effect):
    """The sensor's side follows the piston with a play of width g: a reversal shows only once the play is taken up."""

    gap = Parameter(2e-4, "m", "width g of the play", low=0.0, high=0.1, neutral=0.0)

    play = State("m", "how far the piston is from the middle of the play")

    source = "play operator, Nordin and Gutman 2002, Controlling mechanical systems with backlash - a survey"
    signature = "measured position waits at reversals, then goes on in parallel"
    remedy = "take the play out of the coupling between piston and position sensor, or replace it"

    def equations(v, y_measured, play):
        der_play = v
        y_measured = y_measured - play
        return y_measured, der_play

    def advance(play, gap):
        play = min(max(play, -0.5 * gap), 0.5 * gap)
        return play
