"""Who is told what happens in an experiment: the log, and a program that reads stdout."""

import json
import sys
import threading
from collections.abc import Callable

from rclpy.impl.rcutils_logger import RcutilsLogger


class Teller:
    """Tells sentences to the log, and events as JSON lines to stdout where a program listens.

    That program holds stdin open: when it ends, however it ends, stdin does, and `gone` is called.
    """

    def __init__(self, logger: RcutilsLogger, events: bool, gone: Callable[[], None]) -> None:
        """`events`: whether a program listens."""
        self._logger, self._events, self._gone = logger, events, gone
        if events:
            threading.Thread(target=self._watch, name="stdin", daemon=True).start()

    def tell(self, text: str, event: str = "note", **more: object) -> None:
        """Tell `text`; programs also get the name of the `event` and `more`."""
        if not self._events:
            self._logger.info(text)
            return
        try:
            print(json.dumps({"event": event, "text": text, **more}), flush=True)
        except OSError:  # nobody reads any more
            self._gone()

    def _watch(self) -> None:
        while sys.stdin.buffer.read(1):
            pass
        self._gone()
