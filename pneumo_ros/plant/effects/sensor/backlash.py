"""Play in a coupling: between piston and position sensor, or between piston and load."""

from pneumo_ros.plant.effect import Effect, Parameter, State, pi, sqrt

# of the faces of the play before a load: far stiffer than the air, and soft enough for steps of a millisecond
CONTACT_FREQUENCY = 30.0  # Hz: of the load pressed to a face
CONTACT_DAMPING = 2.0  # damping ratio of the same: a face that was reached is not left by rebound
CONTACT_DEPTH = 0.005  # of the width of the play: depth within which a face takes hold


def pressed(beyond: float, depth: float) -> float:
    """Depth by which a face is pressed in [m]: that beyond it, or hardly anything before it; smooth over `depth`."""
    return 0.5 * (beyond + sqrt(beyond * beyond + depth * depth))


def damped(into: float, depth: float) -> float:
    """Rate [1/s] at which a face pressed in by `into` [m] brakes the load; hardly any before it."""
    hold = into / (into + depth)
    return 4.0 * pi * CONTACT_DAMPING * CONTACT_FREQUENCY * hold * hold


def pushed(into: float, rate: float, depth: float) -> float:
    """Acceleration of the load by a face pressed in by `into` [m] at `rate` [m/s]; a face never pulls."""
    omega = 2.0 * pi * CONTACT_FREQUENCY
    return max(omega * omega * into + damped(into, depth) * rate, 0.0)


class Backlash(Effect):
    """A coupling with a play. The sensor's side follows the piston with a play of width g: a reversal shows only once
    the play is taken up. Or a share of the mass lies between two faces h apart: x' = v_l - v, and v_l' is the
    push of the face that it touches: omega^2 times its depth in it, and 2 zeta omega times its rate.
    """

    gap = Parameter(2e-4, "m", "width g of the play before the sensor", low=0.0, high=0.1, neutral=0.0, role="play")

    load_share = Parameter(
        0.0, "1", "share of the moving mass behind a play", low=0.0, high=0.8, neutral=0.0, usual=0.5
    )
    load_gap = Parameter(
        4e-4, "m", "width h of the play before the load", low=1e-6, high=0.1, optional=True, shapes="load_share",
    )  # fmt: skip

    play = State("m", "how far the piston is from the middle of the play before the sensor")
    ahead = State("m", "how far the load is ahead of the middle of its play")
    v_loose = State("m/s", "velocity of the load", initial="v")

    source = (
        "play operator and dead zone, Nordin and Gutman 2002, Controlling mechanical systems with backlash - a survey"
    )
    signature = "measured position waits at reversals, then goes on in parallel; or the load knocks at each reversal"
    remedy = "take the play out of the coupling between piston and position sensor or load, or replace it"

    def equations(v, y_measured, play, ahead, v_loose, mass, load_share, load_gap):
        der_play = v
        y_measured = y_measured - play
        depth = CONTACT_DEPTH * load_gap
        front = pressed(ahead - 0.5 * load_gap, depth)
        back = pressed(-ahead - 0.5 * load_gap, depth)
        rate = v_loose - v
        der_ahead = rate
        der_v_loose = pushed(back, -rate, depth) - pushed(front, rate, depth)
        rate_v_loose = damped(front, depth) + damped(back, depth)
        load = load_share * mass
        added_mass = -load
        force = load * der_v_loose
        resistance = load * rate_v_loose
        return y_measured, der_play, der_ahead, der_v_loose, rate_v_loose, added_mass, force, resistance

    def advance(play, gap):
        play = min(max(play, -0.5 * gap), 0.5 * gap)
        return play
