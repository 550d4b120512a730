"""The procedure: wiring, static and dynamic trials, then the moves that narrow the intervals most, until none pays."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from pneumo_ros.commission import moves
from pneumo_ros.commission.information import MINUTE, Knowledge, Told, knowledge, shrinkage, told
from pneumo_ros.commission.performing import Perform, Performed
from pneumo_ros.commission.safe import LIMIT, again, agreeing, may_be_tried_again, safe, unmoved
from pneumo_ros.commission.settling import settled
from pneumo_ros.commission.simulated import SimulatedRig
from pneumo_ros.commission.slips import surely_static
from pneumo_ros.commission.wiring import MOVED, UnmovedError, Wired, as_run, find_wiring
from pneumo_ros.diagnose.evidence import Evidence
from pneumo_ros.errors import DataError, NumericalError, UsageError
from pneumo_ros.experiment.beside import counted_from
from pneumo_ros.experiment.plumbing import plumbing
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.whitened import Noise
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import centred, closed_signal
from pneumo_ros.records import Recording
from pneumo_ros.runs.run import Run

Tell = Callable[[str], object]

ENOUGH = 0.1  # share by which the next minute must narrow the intervals, or the moves end
MOST = 200  # moves
STRONGER = (1.0, 2.0, 4.0)  # factors of the voltages of the plumbing trial, until the piston moves
WIDE = 60  # machines as the data sheet leaves them, of which some agree with what was not expected
FARTHER = 3.0  # times as far beyond the dead zone as before: the most that is tried next
AGAIN = 4  # times that a trial is tried with other voltages, where it was ended at a limit or did not move


class UnmadeError(DataError):
    """The piston stayed where it was, at all voltages that are known to be safe; `seconds` of the plant's time."""

    def __init__(self, text: str, seconds: float) -> None:
        super().__init__(text)
        self.seconds = seconds


@dataclass(frozen=True)
class Move:
    """A programme that was performed: recordings, seconds, and the deviations predicted before and found after it."""

    name: str
    recordings: tuple[str, ...]
    seconds: float
    predicted: dict[str, float] = field(default_factory=dict)
    found: dict[str, float] = field(default_factory=dict)

    @property
    def ratio(self) -> float:
        """Achieved over predicted deviations, the geometric mean; NaN where nothing was predicted."""
        if not self.predicted:
            return float("nan")
        return float(np.exp(np.mean([np.log(self.found[n] / self.predicted[n]) for n in self.predicted])))


@dataclass(frozen=True)
class Commissioned:
    """The machine and what is known of it.

    left: share by which another minute, best with `next_move`, would narrow the intervals; lacking: parameters that
    stay as data sheets say.
    """

    before: Model
    wired: Wired
    moves: tuple[Move, ...]
    knowledge: Knowledge
    runs: tuple[Run, ...]
    left: float
    next_move: str

    @property
    def machine(self) -> Model:
        """The machine that was found, with its standard deviations as uncertainty."""
        return self.knowledge.model.with_uncertainty(self.knowledge.deviations)

    @property
    def seconds(self) -> float:
        """Time of the plant that it took [s]."""
        return sum(move.seconds for move in self.moves)

    @property
    def lacking(self) -> tuple[str, ...]:
        """Parameters that the trials do not determine."""
        return tuple(name for name, one in self.knowledge.estimates.items() if not one.determined)


@dataclass
class Commissioning:
    """A commissioning under way. `perform` moves the plant; `tell` gets a sentence for each step."""

    model: Model  # as data sheets tell it
    perform: Perform
    words: tuple[str, ...] = ()  # what is known of the wiring, words of --read-as
    sensors: tuple[str, ...] | None = None  # words of the pressure sensors; None: they are guessed
    minutes: float = 5.0  # of moves, at most
    tell: Tell = lambda text: None

    def __post_init__(self) -> None:
        self.model.require_two_chambers("commissioning")
        self.runs: list[Run] = []
        self.moves: list[Move] = []
        self.known = knowledge(self.model, ())
        self.wired = Wired(self.words, False)
        self._static: Performed | None = None  # made already, to see the wiring
        self._unmade: set[str] = set()  # moves at which the piston stays
        self._refuted = False  # the plant has done what the machine as found would not do: the next fit begins anew

    # --- stage 0 ------------------------------------------------------------------------------------------------------

    def wiring(self) -> Wired:
        """Ten seconds at low opening: how the rig is wired. DataError where a sensor is dead or nothing moves.

        Where that does not decide, and what is left are mirror images, which move alike, the static trials follow.
        """
        ramps = None
        for stronger in STRONGER:
            ramps = self._ramps(stronger, ramps)
            done = self._performed(ramps, "wiring")
            self.moves.append(Move("wiring", _names(done), done.seconds))
            try:
                self.wired = find_wiring(done.recordings, self.model, self.words, self.sensors)
                break
            except UnmovedError as error:
                if stronger == STRONGER[-1]:
                    raise
                self.tell(f"wiring: {str(error).partition(':')[0]}; tried again with larger ones")
        self._look(done)
        static = None if self.wired.certain else self._safe(moves.static(self.known.model))
        if static is not None:
            self.tell("wiring: another one explains this nearly as well; static trials will tell")
            self._static = self._performed(static, "static")
            recordings = (*done.recordings, *self._static.recordings)
            self.wired = find_wiring(recordings, self.model, self.words, self.sensors)
            self._look(done)
        return self.wired

    def _ramps(self, stronger: float, before: Programme | None) -> Programme:
        """The plumbing trial, safe for machines as they may be, or at least for that of the data sheet.

        before: ramps at which the piston stayed, and so do machines that may be; after them, only larger ones help.
        """
        ramps = counted_from(plumbing(centred(self.model), stronger=stronger), closed_signal(self.model))
        least = before.trials[0].voltage.largest if before else 0.0
        possible = unmoved(before, self._possible(), MOVED) if before else self._possible()
        for machines in (possible, [self.known.model]):
            made = safe(ramps, machines) if machines else None
            if made is not None and made.trials[0].voltage.largest > least:
                return made
        raise DataError(f"ramps above {least:g} V may take the piston from mid stroke to an end stop")

    def _look(self, done: Performed) -> None:
        """Know the machine by the plumbing trial: how easily it moves."""
        self.runs = [self._run(recording) for recording in done.recordings]
        with suppress(DataError, UsageError):  # hardly any motion, or none that this machine could make
            known = knowledge(self.model, self.runs)
            known.model.state()
            self.known = known

    # --- stages 1 and 2 -----------------------------------------------------------------------------------------------

    def basics(self) -> None:
        """Static and dynamic trials, and the first fit to them. Needs `wiring`."""
        for name, make in (("static", moves.static), ("dynamic", moves.dynamic)):
            if name == "static" and self._static is not None:
                self._learn(name, self._static)
                continue
            programme = self._safe(make(self.known.model))
            if programme is None:
                self.tell(f"{name}: left out, as even its smallest voltages may take the piston to an end stop")
                continue
            self._taken(name, programme)

    # --- stage 3 ------------------------------------------------------------------------------------------------------

    def best_move(self) -> tuple[float, Programme | None, Told]:
        """The move that narrows the intervals most: its share per minute, the programme, and what it would tell."""
        best: tuple[float, Programme | None, Told] = (0.0, None, self.known.told)
        possible = self._possible()
        for candidate in moves.candidates(self.known.model, seed=len(self.moves)):
            if candidate.experiment in self._unmade:
                continue
            programme = safe(self._probing(candidate), possible, [self._stands()])
            predicted = self._predicted(programme) if programme else None
            if predicted is not None and (share := shrinkage(self.known.told, *predicted)) > best[0]:
                best = share, programme, predicted[0]
        return best

    def run(self) -> Commissioned:
        """All stages; ends where the next minute would gain less than a tenth, or after `minutes` of moves.

        Raises DataError where nothing can be moved within the limits.
        """
        if not self.moves:
            self.wiring()
        self.basics()
        if not self.runs:
            raise DataError("no trial can be made that stays within the stroke; give the machine file narrower figures")
        for _ in range(MOST):
            share, programme, more = self.best_move()
            name = programme.experiment if programme else "nothing"
            self.tell(f"another minute, best with {name}, would narrow the intervals by {100 * share:.0f} %")
            spent = sum(move.seconds for move in self.moves)
            if programme is None or share < ENOUGH or spent >= MINUTE * self.minutes:
                break
            free = self.known.known
            expected = dict(zip(free.names, self.known.told.beside(more).deviations() * free.prior, strict=True))
            if not self._taken(name, programme):
                continue
            found = {one: self.known.deviations[one] for one in expected}
            done = replace(self.moves[-1], predicted={n: float(d) for n, d in expected.items()}, found=found)
            self.moves[-1] = done
            self.tell(f"{name}: {done.seconds:.0f} s; deviations {done.ratio:.2f} times the predicted ones")
        known = settled(self.model, self.known, self.runs)
        return Commissioned(self.model, self.wired, tuple(self.moves), known, tuple(self.runs), share, name)

    # --- performing ---------------------------------------------------------------------------------------------------

    def _possible(self) -> list[Model]:
        """The machine as found, and some as it may be."""
        known = self.known
        count, seed = moves.DRAWN, len(self.moves)
        return [known.model, *moves.drawn(known.model, known.deviations, count, seed, known.correlation)]

    def _otherwise(self) -> list[Model]:
        """The machine as found and as it may be, and many as the data sheet leaves them: the former may be refuted."""
        wide = knowledge(self.model, ()).deviations
        return [*self._possible(), *moves.drawn(self.model, wide, WIDE, len(self.moves))]

    def _stands(self) -> float:
        """Where the piston stands [m], mid stroke where nothing was recorded yet."""
        return float(self.runs[-1].position[-1]) if self.runs else 0.0

    def _safe(self, programme: Programme) -> Programme | None:
        return safe(self._probing(programme), self._possible(), [self._stands()])

    def _probing(self, programme: Programme) -> Programme:
        """The programme with voltages at most three times as far beyond the dead zone as those that were sent.

        How a valve opens and how a piston jumps is not known far from where it was tried, however sure a fit is.
        """
        if not self.runs:
            return programme
        dead, closed = moves.narrowest([self.known.model]), closed_signal(self.known.model)
        right = max(float(np.max(run.input)) for run in self.runs) - closed - dead[0]
        left = closed - min(float(np.min(run.input)) for run in self.runs) - dead[1]
        return moves.reaching(programme, dead, FARTHER * max(right, left, moves.CREEP))

    def _taken(self, name: str, programme: Programme) -> bool:
        """Whether the move was made; where the piston stays, it is left out from then on, and the others go on."""
        try:
            self._take(name, programme)
        except UnmadeError as error:
            self.moves.append(Move(name, (), error.seconds))
            self._unmade.add(name)
            self.tell(f"{error}; left out")
            return False
        return True

    def _take(self, name: str, programme: Programme) -> None:
        self._learn(name, self._performed(programme, name))

    def _learn(self, name: str, done: Performed) -> None:
        """Fit the machine to what was recorded, too."""
        self.moves.append(Move(name, _names(done), done.seconds))
        for recording in done.recordings:
            self.runs.append(self._run(recording))
        self.known = knowledge(self.model, self.runs, None if self._refuted else self.known.model)
        self._refuted = False

    def _performed(self, programme: Programme, name: str) -> Performed:
        """Performed, with smaller voltages where a limit was reached, and larger ones where the piston did not return.

        UnmadeError where it never moved, DataError where the plant ends it otherwise.
        """
        words = self.words if programme.blind else self.wired.words
        recordings: list[Recording] = []
        seconds = 0.0
        tried = programme
        for number in range(1 + AGAIN):
            folder = f"{len(self.moves):02d}_{name}" + (f"_{number}" if number else "")
            done = self.perform(tried, words, folder)
            seconds += done.seconds
            recordings += done.recordings
            if done.complete:
                return Performed(tuple(recordings), seconds)
            if not may_be_tried_again(done.reason):
                raise DataError(f"{name}: {done.reason}")
            self._refuted = True
            trials = tried.trials[len(done.recordings) :]
            if not trials:  # it ended on the way back from the last one
                break
            left = replace(tried, trials=trials)
            other = again(left, done.reason, agreeing(left, done.reason, self._otherwise(), 1 + moves.DRAWN))
            if other is None:
                self.tell(f"{name}: {done.reason}; no other voltages are safe")
                break
            self.tell(
                f"{name}: {done.reason}; tried again with {'smaller' if LIMIT in done.reason else 'larger'} voltages"
            )
            tried = other
        if recordings:
            return Performed(tuple(recordings), seconds, done.reason)
        text = f"{name}: {done.reason}; tried {number + 1} times, and no other voltages are known to be safe"
        raise DataError(text) if LIMIT in done.reason else UnmadeError(text, seconds)

    def _run(self, recording: Recording) -> Run:
        return as_run(recording, self.model, self.wired.words)

    def _predicted(self, programme: Programme) -> tuple[Told, float] | None:
        """What the programme would tell on the machine as found, and its seconds; None where it cannot be made."""
        run, model = self.runs[-1], self.known.model
        pressures = [run.noise[name] for name in (chamber.signal for chamber in model.chambers)]
        noise = Noise(run.noise["position_m"], float(np.mean(pressures)))
        rig = SimulatedRig(model, sample_time=run.sample_time, noise=noise, seed=1)
        try:
            done = rig.perform(programme, (), "predicted")
            evidence = Evidence(self.model, [as_run(recording, model, ()) for recording in done.recordings])
            evidence = surely_static(evidence, model)
            return told(evidence, model, self.known.known, self.known.told.scales), done.seconds
        except (DataError, NumericalError, ValueError):
            return None


def _names(done: Performed) -> tuple[str, ...]:
    return tuple(recording.name for recording in done.recordings)
