"""What a commissioning asks of a plant: perform a programme, wired as it is, and give the recordings."""

from collections.abc import Callable
from dataclasses import dataclass

from pneumo_ros.experiment.programme import Programme
from pneumo_ros.records import Recording


@dataclass(frozen=True)
class Performed:
    """Recordings of the finished trials as the rig made them, and the reason where the programme was ended early."""

    recordings: tuple[Recording, ...]
    seconds: float  # of the plant's time
    reason: str = ""

    @property
    def complete(self) -> bool:
        """Whether every trial was finished."""
        return not self.reason


# programme, words of --read-as that it is to be wired by, and the folder's name for its recordings
Perform = Callable[[Programme, tuple[str, ...], str], Performed]
