"""Events of an experiment: sentences for the log, or lines of JSON for a program that reads stdout."""

import json
import sys
import threading
from collections.abc import Callable


class Events:
    """Reports sentences to the log, or events as JSON lines to stdout where a program listens.

    That program holds stdin open. When it ends, in whatever way, stdin ends and `gone` is called.
    """

    def __init__(self, log: Callable[[str], object], events: bool, gone: Callable[[], None]) -> None:
        """`log` takes a sentence; `events`: whether a program listens."""
        self._log, self._events, self._gone = log, events, gone
        if events:
            threading.Thread(target=self._watch, name="stdin", daemon=True).start()

    def report(self, text: str, event: str = "note", **more: object) -> None:
        """Report `text`; programs also get the name of the `event` and `more`."""
        if not self._events:
            self._log(text)
            return
        try:
            print(json.dumps({"event": event, "text": text, **more}), flush=True)
        except OSError:  # nobody reads any more
            self._gone()

    def _watch(self) -> None:
        while sys.stdin.buffer.read(1):
            pass
        self._gone()
