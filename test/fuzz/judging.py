"""The permitted answers of a parser: a result, or a short error message; soon, and in little memory."""

import resource
import signal
import time
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from fuzz.parsers import Parser
from pneumo_ros.errors import PneumoError

TIME = 10.0  # s of processor time: a busy machine is not the parser's fault
MEMORY = 1 << 30  # bytes above the use of Python and its libraries
WORDS = 2000  # characters of a message to a person
CANARY = "canary"  # the file that code in an input would create

ERROR, RESULT, BROKEN = "clear error", "result", "traceback"


class Verdict(NamedTuple):
    """The verdict on one input, the processor time [s], and the text of the error or traceback."""

    kind: str
    seconds: float
    words: str


class TooSlowError(BaseException):
    """Beyond TIME; no handler of the package may catch it."""


@contextmanager
def limited() -> Iterator[None]:
    """The limits of time and warnings: a warning of Python on stderr is not a clear answer either."""
    previous = signal.signal(signal.SIGPROF, _ring)
    signal.setitimer(signal.ITIMER_PROF, TIME)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("error", module="pneumo_ros")
            yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, previous)


def _ring(number: int, frame: object) -> None:
    raise TooSlowError(f"no answer within {TIME:g} s")


def judge(parser: Parser, data: bytes, folder: Path) -> Verdict:
    """The verdict on `data` given to `parser` as a file in `folder`, which is the working directory meanwhile."""
    path = parser.put(folder, data)
    begin = time.process_time()
    try:
        with limited():
            parser.read(path)
        kind, words = RESULT, ""
    except PneumoError as error:
        kind, words = ERROR, str(error)
        if not 10 <= len(words) <= WORDS:
            kind, words = BROKEN, f"the message has {len(words)} characters: {words[:200]}"
    except (Exception, TooSlowError):  # any other exception, which a user would see as a traceback
        kind, words = BROKEN, traceback.format_exc()
    seconds = time.process_time() - begin
    if any(Path(place, CANARY).exists() for place in (folder, ".")):
        kind, words = BROKEN, "code of the input was run"
    return Verdict(kind, seconds, words)


def limit_memory() -> None:
    """Allocations beyond MEMORY fail in this process from now on, and show as tracebacks."""
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))


def peak() -> float:
    """Most memory this process has had [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
