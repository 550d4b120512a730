"""Output of a verb: results on stdout, messages and progress on stderr, JSON where requested."""

import json
import logging
import math
import shutil
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO

from pneumo_ros.files import check_writable, write_whole

if TYPE_CHECKING:
    from pneumo_ros.wording.table import Table


class Console:
    """Output of one command.

    quiet: no messages and no progress; results and errors remain.
    json_target: where `json` writes: a file, "-" for stdout (which then carries nothing else), or None.
    """

    def __init__(self, quiet: bool = False, json_target: str | None = None) -> None:
        self.quiet = quiet
        self.json_target = json_target
        self._json_path = Path() if json_target in (None, "-") else check_writable(str(json_target))
        self._listen()

    def _listen(self) -> None:
        """Show the log of the package, such as the compilation of a kernel, beside the other messages."""
        logger = logging.getLogger("pneumo_ros")
        logger.handlers = [logging.StreamHandler(sys.stderr)]
        logger.setLevel(logging.ERROR if self.quiet else logging.INFO)

    def say(self, text: str = "") -> None:
        """A result for a person to read."""
        if self.json_target != "-":
            print(text, flush=True)

    def note(self, text: str) -> None:
        """A message beside the results."""
        if not self.quiet:
            print(text, file=sys.stderr, flush=True)

    def next(self, words: str) -> None:
        """What to type next, after `pneumo`."""
        self.note(f"Next: {program()} {words}")

    def progress(self, title: str) -> "Progress":
        """Progress of long work: `with console.progress("Comparing") as progress: ...; progress(0.4)`."""
        return Progress(title, None if self.quiet else sys.stderr)

    def json(self, data: dict[str, Any]) -> None:
        """The results for a program, if requested; numbers that are not finite become null."""
        if self.json_target is None:
            return
        text = json.dumps(plain(data), indent=1, allow_nan=False) + "\n"
        if self.json_target == "-":
            sys.stdout.write(text)
        else:
            write_whole(self._json_path, text)


def program() -> str:
    """How to call this command again: by its name where the shell finds it, else as it was called."""
    called = Path(sys.argv[0])
    if called.name == "pneumo" and not shutil.which("pneumo"):
        return str(called)
    return "python -m pneumo_ros" if called.name == "__main__.py" else "pneumo"


def plain(value: Any) -> Any:
    """`value` in the types of JSON: numpy scalars and arrays unpacked, NaN and infinities as None, paths as text."""
    if isinstance(value, dict):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(inner) for inner in value]
    if hasattr(value, "tolist"):  # numpy, recognised without importing it
        return plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return str(value) if isinstance(value, Path) else value


def columns(rows: Sequence[Sequence[str]], right: Sequence[int] = ()) -> str:
    """Rows of text as aligned columns, two spaces apart; the column numbers in `right` align to the right."""
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]

    def line(row: Sequence[str]) -> str:
        cells = (c.rjust(w) if i in right else c.ljust(w) for i, (c, w) in enumerate(zip(row, widths, strict=True)))
        return "  ".join(cells).rstrip()

    return "\n".join(line(row) for row in rows)


def table_text(table: "Table | None") -> str:
    """A table below its title, its rows indented; empty where there is nothing to show."""
    if table is None or not table.rows:
        return ""
    rows = [(f"  {first}" if first else "", *others) for first, *others in table.rows]
    return (f"{table.title}:\n" if table.title else "") + columns([table.head, *rows], right=table.numeric)


class Progress:
    """Call it with the fraction done, 0 to 1, and what is being done.

    On a terminal it is one moving line, elsewhere one per 10 % or thing done; both show the estimated time left, which
    never rises: where the work takes much longer than that, it says so and shows no time.
    """

    WAIT = 0.5  # s; work that ends sooner shows nothing
    GUESS = 3.0  # s of work before the rest is estimated ...
    ENOUGH = 0.1  # ... and the share of it that must be done
    SLIP = 2.0  # times the time left as it was shown, beyond which it is no longer shown

    def __init__(self, title: str, stream: TextIO | None) -> None:
        self.title, self.stream = title, stream
        self.moving = stream is not None and stream.isatty()
        self._start, self._shown, self._drawn, self._doing = time.monotonic(), 0, 0.0, ""
        self._end = math.inf  # when the work ends, by the earliest estimate so far

    def __enter__(self) -> "Progress":
        return self

    def __exit__(self, *failure: object) -> None:
        self.clear()

    def clear(self) -> None:
        """Remove the moving line, so that something else can be printed."""
        if self.stream is not None and self.moving and self._drawn:
            self.stream.write("\r\x1b[K")
            self.stream.flush()

    def __call__(self, fraction: float, doing: str = "") -> None:
        now = time.monotonic()
        if self.stream is None or now - self._start < self.WAIT:
            return
        share = min(max(fraction, 0.0), 1.0)
        percent = int(100 * share)
        said = self._left(share, now) + (f": {doing}" if doing else "")
        if self.moving:
            self._draw(percent, now, said)
        elif (percent // 10 > self._shown and (self._shown or percent < 100)) or doing != self._doing:
            self._shown, self._doing = percent // 10, doing
            print(f"{self.title}: {percent if doing else 10 * self._shown} %{said}", file=self.stream, flush=True)

    def _left(self, share: float, now: float) -> str:
        """', about 20 s left', once enough is done to estimate it; less each time that it is shown."""
        passed = now - self._start
        if passed < self.GUESS or not self.ENOUGH <= share < 1.0:
            return ""
        estimated = passed * (1.0 - share) / share
        self._end = min(self._end, now + estimated)
        seconds = max(self._end - now, 0.0)
        if estimated > self.SLIP * max(seconds, 0.5):
            return ", longer than estimated"
        return f", about {seconds:.0f} s left" if seconds < 100.0 else f", about {seconds / 60.0:.0f} min left"

    def _draw(self, percent: int, now: float, said: str) -> None:
        if self.stream is None or now - self._drawn < 0.1:
            return
        self._drawn = now
        line = f"{self.title} [{'#' * (percent // 4):<25}] {percent:3d} % {now - self._start:4.0f} s{said}"
        self.stream.write(f"\r{line[: shutil.get_terminal_size().columns - 1]}\x1b[K")
        self.stream.flush()
