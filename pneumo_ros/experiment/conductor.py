"""Runs a programme sample by sample, measurement in, voltage out; the same on a plant and in a rehearsal."""

import math
from collections.abc import Callable, Generator

from pneumo_ros.experiment.programme import Programme, Trial
from pneumo_ros.experiment.trace import Trace
from pneumo_ros.experiment.trial_result import AbortedError, TrialResult
from pneumo_ros.experiment.voltages import Ramps

STILL, WITHIN = 0.3, 3e-4  # s, m: a piston rests if it stays this long within this distance
CALM = 10.0  # s: longest wait for rest at closed valve
SLIP = 2e-3  # m: the piston has broken away
WRONG = 2e-2  # m of motion the wrong way that end the experiment
STUCK = 10.0  # s without SLIP of progress on the way back
NEAR = 0.05  # of the room: tolerance of a start position at the limit
LAST = 1.0  # s over which the final speed is taken
BRAKE, PRESENT = 0.02, 0.05  # m/s above which the valve brakes; s over which the present speed is taken
AHEAD = 0.1  # s that a piston coasts after its valve has closed: a ramp ends so much earlier
PAUSE = 0.5  # s at closed valve between two ramps of a blind programme
# s: longest time for which a piston that jumps gathers speed, while its valve lets the pressure out; time over which
# its speed is taken, short beside that
GATHERS, SHORT = 0.1, 0.01
MOVED, READ = 4.0, 10.0  # `end`s beyond which a blind position has moved, or reads, in mm: no piston is there in m

Voltages = Generator[float, None, None]


class Conductor:
    """Takes the piston through a programme. `step` returns the voltage for each measurement until `done`.

    `recording` is the name of the trial that is to be recorded from this measurement on, None between trials.
    """

    def __init__(self, programme: Programme, tell: Callable[[str], None] = lambda text: None) -> None:
        """`tell` is called with each progress message."""
        self.programme, self._tell = programme, tell
        self.recording: str | None = None
        self.outcomes: list[TrialResult] = []
        self.done = False
        self.index = 0  # of the present or next trial
        self.time = self.position = 0.0
        self._inside = False
        self._metre = 1.0  # of a blind programme: m for one unit of the position
        self._now, self._late, self._short = Trace(PRESENT), Trace(LAST), Trace(SHORT)
        self._voltages = self._all()

    def step(self, time: float, position: float) -> float:
        """Voltage [V] from `time` [s, any origin] on, with the piston at `position` [m].

        Raises AbortedError when the plant must be stopped; after that, and when all is done, the voltage is 0.
        """
        self.time, self.position = time, position
        self._check()
        self._now.add(time, position)
        self._short.add(time, position)
        return next(self._voltages, 0.0)

    def _check(self) -> None:
        """The piston may start at or near the end of its stroke, but must not be driven there."""
        if not math.isfinite(self.position):
            self._stop(f"the position is {self.position}; check the sensor")
        if self.programme.blind:
            return
        if self.programme.low <= self.position <= self.programme.high:
            self._inside = True
        elif self._inside and abs(self.position) >= self.programme.end:
            self._stop(f"the piston has reached the end stop, {self.position:+.3f} m (end: {self.programme.end:g} m)")

    def _stop(self, reason: str) -> None:
        self.recording = None
        self._voltages = _nothing()
        raise AbortedError(reason)

    # --- the steps in their order: each yields voltages ---------------------------------------------------------------

    def _all(self) -> Voltages:
        for index, trial in enumerate(self.programme.trials):
            self.index = index
            yield from self._settle()
            if not (trial.anywhere or self.programme.blind) and (way := self._way_to_start(trial)):
                yield from self._go(*way)
                yield from self._settle()
            yield from self._run(trial)
        yield from self._settle()
        self.done = True

    def _settle(self) -> Voltages:
        """Brake, then close the valve until the piston rests.

        Closed chambers keep their pressures: without braking the piston coasts for decimetres.
        """
        if self.programme.blind:  # no sign to brake by, no unit to judge rest by
            yield from self._hold(PAUSE)
            return
        direction = 1 if self._now.speed > 0.0 else -1
        while direction * self._now.speed > BRAKE:
            yield -direction * self._moderate(-direction)
        begin = since = self.time
        where = self.position
        while self.time - since < STILL:
            if self.time - begin > CALM:
                self._tell(f"the piston does not come to rest at 0 V ({self.position:+.4f} m after {CALM:g} s)")
                return
            yield 0.0
            if abs(self.position - where) > WITHIN:
                where, since = self.position, self.time

    def _way_to_start(self, trial: Trial) -> tuple[int, float] | None:
        """Direction and target [m] of the move to the trial's start; None if the trial can start here."""
        low, high, span = self.programme.low, self.programme.high, self.programme.span
        if trial.direction:
            least = min(trial.travel, (1.0 - 2.0 * NEAR) * span) if self.outcomes else (1.0 - 2.0 * NEAR) * span
            if self._room(trial.direction) >= least:
                return None
            return -trial.direction, low + NEAR * span if trial.direction > 0 else high - NEAR * span
        offset = self.position - 0.5 * (low + high)
        if abs(offset) < 0.15 * span:
            return None
        return (-1, 0.5 * (low + high) + NEAR * span) if offset > 0.0 else (1, 0.5 * (low + high) - NEAR * span)

    def _go(self, direction: int, target: float) -> Voltages:
        """Move to `target` [m] at a moderate voltage."""
        volts = self._moderate(direction)
        start = best = self.position
        since = self.time
        while direction * (target - self.position) > 0.0:
            self._watch(direction, start, direction * volts)
            if direction * (self.position - best) > SLIP:
                best, since = self.position, self.time
            elif self.time - since > STUCK:
                self._stop(
                    f"at {direction * volts:+.2f} V the piston stays at {self.position:+.3f} m; is the supply on, and "
                    "does the valve get the command? (a higher return_right and return_left may help)"
                )
            yield direction * volts

    def _watch(self, direction: int, start: float, volts: float) -> None:
        if direction * (self.position - start) < -WRONG:
            self._stop(
                f"at {volts:+.2f} V the piston went {1e3 * abs(self.position - start):.0f} mm the wrong way: hoses or "
                "the sign of valve or position are swapped, or a load is stronger than the pressure"
            )

    def _run(self, trial: Trial) -> Voltages:
        """A rest, then the trial's voltage, both recorded."""
        self.recording = trial.name
        yield from self._hold(self.programme.rest)
        opened, start = self.time, self.position
        self._late = Trace(LAST)
        if isinstance(trial.voltage, Ramps):
            ended = yield from self._ramp(trial.voltage, trial.seconds)
        else:
            ended = yield from (self._push(trial) if trial.direction else self._excite(trial))
        self.recording = None
        seconds, way = self.time - opened, abs(self.position - start)
        self.outcomes.append(TrialResult(trial.name, trial.voltage.text, ended, seconds, way, self._late.speed))

    def _hold(self, seconds: float) -> Voltages:
        """The closed valve for `seconds`."""
        begin = self.time
        while self.time - begin < seconds:
            yield 0.0

    def _ramp(self, ramps: Ramps, seconds: float) -> Generator[float, None, str]:
        """Ramps to and fro, each until the piston is `way` beyond where it stood first.

        A piston that goes farther one way than back would come to an end stop after some ramps. Until one ramp has
        moved it, the sign of the position is not known, and only its way counts.
        """
        begin, home, direction, count, sign = self.time, self.position, 1, 0, 0.0
        while count < 2 or self.time - begin < seconds:
            opened, start = self.time, self.position
            while self.time - opened < ramps.seconds and not self._gone(home, start, direction * sign, ramps.way):
                self._late.add(self.time, self.position)
                yield direction * ramps.at(self.time - opened)
            if self.time - opened < ramps.seconds:
                if sign == 0.0:
                    sign = direction * math.copysign(1.0, self._now.speed)
                    home = home if count == 0 else self.position
                yield from self._let_out(-direction * ramps.at(self.time - opened))
            yield from self._hold(PAUSE)
            if sign == 0.0 and self._metre * abs(self.position - start) >= 0.5 * ramps.way:
                sign = direction * math.copysign(1.0, self.position - start)
                home = home if count == 0 else self.position  # it stood at an end stop, or is stuck one way
            direction, count = -direction, count + 1
        return "time"

    def _let_out(self, volts: float) -> Voltages:
        """The opposite voltage while the piston gathers speed: closed chambers would keep what drives it."""
        begin, fastest = self.time, 0.0
        while self.time - begin < GATHERS and abs(self._short.speed) > fastest:
            fastest = abs(self._short.speed)
            yield volts

    def _gone(self, home: float, start: float, sense: float, way: float) -> bool:
        """Whether the piston is `way` [m] from `home` to the side of `sense`; 0: whether it moved so far from `start`.

        What moves by strokes, or reads many of them, is in mm: in metres it would have left the cylinder.
        """
        if abs(self.position - home) > MOVED * self.programme.end or abs(self.position) > READ * self.programme.end:
            self._metre = 1e-3
        soon = self.position + AHEAD * self._now.speed
        if sense == 0.0:
            return self._metre * abs(soon - start) >= way
        return self._metre * sense * (soon - home) >= way

    def _push(self, trial: Trial) -> Generator[float, None, str]:
        """Move one way until travel, time or room is used up; returns why it ended."""
        opened, start = self.time, self.position
        moved: float | None = None  # when it broke away
        ended: str | None = None
        while ended is None:  # at the latest when the trial's time is up
            way = trial.direction * (self.position - start)
            volts = trial.voltage.at(self.time - opened)
            self._watch(trial.direction, start, volts)
            if moved is None and way > SLIP:
                moved = self.time
            ended = self._ended(trial, way, opened, moved)
            if ended is None:
                self._late.add(self.time, self.position)
                yield volts
        return ended

    def _ended(self, trial: Trial, way: float, opened: float, moved: float | None) -> str | None:
        """Why a one-way trial ends now, a key of `trial_result.ENDS`; None while it goes on."""
        if self._room(trial.direction) <= 0.0:
            return "limit"
        if way >= trial.travel:
            return "travel"
        if moved is None:
            return "still" if self.time - opened >= trial.patience else None
        return "time" if self.time - moved >= trial.seconds else None

    def _excite(self, trial: Trial) -> Generator[float, None, str]:
        """Move both ways for a given time; beyond a limit the voltage points inwards."""
        opened = self.time
        while self.time - opened < trial.seconds:
            volts = trial.voltage.at(self.time - opened)
            self._late.add(self.time, self.position)
            yield -volts if self._room(1 if volts > 0.0 else -1) <= 0.0 else volts
        return "time"

    def _moderate(self, direction: int) -> float:
        """Magnitude of the voltage that moves the piston at a moderate speed [V]."""
        return self.programme.return_right if direction > 0 else self.programme.return_left

    def _room(self, direction: int) -> float:
        """Distance to the limit [m]."""
        return self.programme.high - self.position if direction > 0 else self.position - self.programme.low


def _nothing() -> Voltages:
    """No more voltages."""
    yield from ()
