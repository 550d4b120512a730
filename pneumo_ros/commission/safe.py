"""Programmes made safe for what is not known yet of the machine: nothing is sent that was not rehearsed."""

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pneumo_ros.commission.moves import narrowest, returning, smaller
from pneumo_ros.errors import NumericalError
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.rehearsal import rehearse
from pneumo_ros.plant import Model

LESS, FEWEST = 0.6, 0.05  # a move that would leave the limits is tried with this share of its voltages; smallest share
MORE = (1.4, 1.2, 1.1)  # factors of the voltages that take a piston back that stayed at them
ROOMS = (1.0, 0.6, 0.35)  # of the way between the limits, where less voltage does not help: a jump takes its way
CLEAR = 0.95  # of the way to the end stop, beyond which no rehearsed piston may come
LATE = 0.012  # s between two decisions of a rehearsal: a rig's commands come as late
LIMIT, STAYS = "end stop", "stays at"  # in the reason for which a programme was ended


def safe(programme: Programme, machines: Sequence[Model], starts: Sequence[float] = (0.0,)) -> Programme | None:
    """The programme with voltages small enough that none of `machines` reaches an end stop; None where none are.

    starts: positions [m] where the piston may stand at first. They keep clear of the end stop if they can. A piston
    whose friction at rest is a multiple of that in motion jumps as far at any voltage, and hardly open valves brake it
    less: it turns nearer to mid stroke.
    """
    dead = narrowest(machines)
    shares = [LESS**k for k in range(1 + int(np.log(FEWEST) / np.log(LESS)))]
    for clear, room, share in itertools.product((CLEAR, 1.0), ROOMS, shares):
        tried = replace(smaller(programme, dead, share), low=room * programme.low, high=room * programme.high)
        if _all_clear(tried, machines, starts, clear):
            return tried
    return None


def again(programme: Programme, reason: str, machines: Sequence[Model]) -> Programme | None:
    """What to send after `programme` was ended for `reason`: smaller voltages, or larger ones to take the piston back.

    machines: those that agree with the reason. It is rehearsed from mid stroke and from both limits, as the piston may
    stand anywhere. None where nothing is safe, or no machine agrees.
    """
    if not machines:
        return None
    starts = _anywhere(programme)
    if LIMIT in reason:
        return safe(smaller(programme, narrowest(machines), LESS), machines, starts)
    for clear, more in itertools.product((CLEAR, 1.0), MORE):
        tried = returning(programme, (0.0, 0.0), more)
        if _all_clear(tried, machines, starts, clear):
            return tried
    return None


def agreeing(programme: Programme, reason: str, machines: Sequence[Model], most: int) -> list[Model]:
    """The first `most` of `machines` on which `programme` may be ended for the kind of `reason`, too.

    What a machine was known to be is refuted where the plant does what it would not do.
    """
    kind = LIMIT if LIMIT in reason else STAYS

    def agrees(machine: Model) -> bool:
        try:
            return any(kind in rehearse(programme, machine, y, LATE).aborted for y in _anywhere(programme))
        except NumericalError:
            return False

    return list(itertools.islice(filter(agrees, machines), most))


def _anywhere(programme: Programme) -> tuple[float, float, float]:
    return 0.0, programme.low, programme.high


def unmoved(programme: Programme, machines: Sequence[Model], way: float) -> list[Model]:
    """Those of `machines` that a programme moves less than `way` [m] away from mid stroke."""

    def stays(machine: Model) -> bool:
        try:
            return rehearse(programme, machine, sample=LATE).farthest < way
        except NumericalError:
            return False

    return [one for one in machines if stays(one)]


def may_be_tried_again(reason: str) -> bool:
    """Whether other voltages may mend what a programme was ended for."""
    return LIMIT in reason or STAYS in reason


def _all_clear(programme: Programme, machines: Sequence[Model], starts: Sequence[float], clear: float) -> bool:
    return not any(_reaches_end(programme, one, clear, start) for one, start in itertools.product(machines, starts))


def _reaches_end(programme: Programme, machine: Model, clear: float, start: float) -> bool:
    """Whether the piston goes beyond a share of the way to an end stop, where commands come late as on a rig."""
    turns = max(abs(programme.low), abs(programme.high))  # where a trial turns: short of the end, however near
    nearer = replace(programme, end=max(clear * programme.end, 0.5 * (turns + programme.end)))
    try:
        done = rehearse(nearer, machine, start, sample=LATE)
    except NumericalError:  # stiffer than the steps of the integration: no machine to plan for
        return False
    if programme.blind:  # nothing ends it there: it does not know where it is
        return done.farthest >= nearer.end
    return LIMIT in done.aborted
