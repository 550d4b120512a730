"""As fast as possible, in step with the controller: every measurement waits for its command."""

import time
from collections.abc import Callable
from typing import Protocol

SETTLE = 0.3  # s from the match seen here until the controller sees it, too
WATCH = 0.05  # s between two calls of `watch`
MISSES = 3  # missing commands in a row: the controller is gone, which the middleware notices late


class Log(Protocol):
    """The logger of a node."""

    def info(self, message: str, /) -> object:
        """What has changed."""

    def warning(self, message: str, /, *, throttle_duration_sec: float = 0.0) -> object:
        """What is wrong; no more often than every `throttle_duration_sec` [s]."""


class Lockstep:
    """Runs `send` (publish the present sample) and `advance` (one sample) in turns with the commands.

    Everything happens in callbacks of the executor: a command causes the next sample. Without a controller the plant
    runs on freely. A command that does not come within the timeout is counted and logged, and the plant goes on; after
    three in a row the controller counts as gone until it sends a command.
    """

    def __init__(
        self,
        advance: Callable[[], bool],
        send: Callable[[], None],
        matched: Callable[[], bool],
        paused: Callable[[], bool],
        soon: Callable[[Callable[[], None]], object],
        log: Log,
        *,
        wait: float,
        timeout: float,
    ) -> None:
        """`advance` returns whether the state is still finite, `matched` whether there is a controller; `soon` calls a
        function after all that already waits. Times are wall time [s].
        """
        self._advance, self._send, self._matched, self._paused = advance, send, matched, paused
        self._call_soon, self._log = soon, log
        self._wait, self._timeout = wait, timeout
        self.started = self.closed = self._awaiting = False
        self.answered = self.timeouts = self._missed = 0
        self._since = self._begin = time.monotonic()
        self._met: float | None = None

    def command(self) -> None:
        """A command has come, good or refused: it answers the measurement that waits for one."""
        self._missed = 0
        if self._awaiting:
            self._awaiting = False
            self.answered += 1
            self._go_on()

    def resume(self) -> None:
        """Go on after a pause."""
        if self.started and not self._awaiting:
            self._soon()

    def _go_on(self) -> None:
        if not self._awaiting and not self._paused() and self._advance():
            self.publish()

    def _soon(self) -> None:
        self._call_soon(self._go_on)

    def publish(self) -> None:
        """Send the present sample and wait for its command, if somebody will send one."""
        self._awaiting, self._since = self.closed, time.monotonic()
        self._send()
        if not self._awaiting:
            self._soon()

    def watch(self) -> None:
        """Start when there is a controller, and stop waiting for a late command; call it every WATCH seconds."""
        if not self.started:
            self._start_when_met()
            return
        self._follow_match()
        if self._awaiting and not self._paused() and time.monotonic() - self._since > self._timeout:
            self._miss()

    def _start_when_met(self) -> None:
        now = time.monotonic()
        if self._paused():
            self._begin = now
        elif not self._matched():
            self._met = None
            if now - self._begin > self._wait:
                self._log.warning(
                    f"no controller within {self._wait:g} s (parameter lockstep_wait); the plant runs open loop"
                )
                self._start(closed=False)
        elif self._met is None:
            self._met = now
        elif now - self._met > SETTLE:
            self._start(closed=True)

    def _start(self, closed: bool) -> None:
        self.started, self.closed = True, closed
        self.publish()

    def _follow_match(self) -> None:
        matched = self._missed < MISSES and self._matched()
        if matched == self.closed:
            return
        self.closed = matched
        self._log.info("controller joined" if matched else "controller left; the plant runs open loop")
        if not matched and self._awaiting:
            self._awaiting = False
            self._soon()

    def _miss(self) -> None:
        self._awaiting = False
        self.timeouts += 1
        self._missed += 1
        self._log.warning(
            f"no command within {self._timeout:g} s (parameter lockstep_timeout), {self.timeouts} so far",
            throttle_duration_sec=5.0,
        )
        # Before the first answer the measurement itself may have been lost on its way; later, time must go on.
        if self.answered == 0 and time.monotonic() - self._begin < self._wait:
            self.publish()
        else:
            self._soon()
