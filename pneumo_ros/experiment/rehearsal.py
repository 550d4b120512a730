"""A programme rehearsed with a model: how long it takes, how far it goes, where it ends."""

from dataclasses import dataclass

from pneumo_ros.errors import NumericalError, UsageError
from pneumo_ros.experiment.conductor import Conductor
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.trial_result import AbortedError, TrialResult
from pneumo_ros.plant import Model
from pneumo_ros.plant.closed import check_one_command
from pneumo_ros.plant.stepper import Stepper

SAMPLE = 4e-3  # s; the conductor's decisions do not depend on milliseconds
NEAR = 0.9  # of the way to the end stop: a model that fails beyond it has failed at its end
EVERY = 0.1  # s between two points of the path that is kept


@dataclass(frozen=True)
class Rehearsal:
    """The course of a programme on a model.

    outcomes: one per trial; duration [s] and way [m] in total; farthest [m] from mid stroke; path: (time, position)
    every 0.1 s; commands: (time, voltage) at each change; recorded: (begin, end) of each trial; aborted: why it had to
    be stopped, empty if it went well.
    """

    outcomes: tuple[TrialResult, ...]
    duration: float
    way: float
    farthest: float
    path: tuple[tuple[float, float], ...]
    commands: tuple[tuple[float, float], ...]
    recorded: tuple[tuple[float, float], ...]
    aborted: str


def rehearse(programme: Programme, model: Model, position: float = 0.0, sample: float = SAMPLE) -> Rehearsal:
    """Run `programme` on `model`, at rest at `position` [m], deciding every `sample` [s].

    Raises UsageError for a model without valve, NumericalError for one that is too stiff for its steps.
    """
    if model.force_driven:
        raise UsageError(
            f"{model.name} has no chambers, so no valve moves it; give --model a machine file with chambers"
        )
    check_one_command(model)
    plant = Stepper(model, model.state(y=position), sample_time=sample)
    conductor = Conductor(programme)
    path, commands, way, farthest = [(0.0, position)], [(0.0, programme.closed)], 0.0, abs(position)
    recorded: list[tuple[float, float]] = []
    last, aborted = None, ""
    try:
        while not conductor.done:
            before = float(plant.state[0])
            volts = programme.closed + conductor.step(plant.time, before)
            if conductor.recording != last and conductor.recording is not None:
                recorded.append((plant.time, plant.time))
            if (last := conductor.recording) is not None:
                recorded[-1] = (recorded[-1][0], plant.time + sample)
            if volts != commands[-1][1]:
                commands.append((plant.time, volts))
            after = float(plant.advance(volts)[0])
            way, farthest = way + abs(after - before), max(farthest, abs(after))
            if plant.time - path[-1][0] >= EVERY:
                path.append((plant.time, float(plant.state[0])))
    except AbortedError as error:
        aborted = str(error)
    except NumericalError:  # within a sample the piston has left nothing of a chamber
        if abs(float(plant.state[0])) < NEAR * programme.end:
            raise
        aborted = f"the piston has reached the end stop, {plant.state[0]:+.3f} m (end: {programme.end:g} m)"
    commands.append((plant.time, programme.closed))
    return Rehearsal(
        tuple(conductor.outcomes), plant.time, way, farthest, tuple(path), tuple(commands), tuple(recorded), aborted
    )
