"""SIGINT and SIGTERM request the end; rclpy's own handlers would end its context before the last messages are sent."""

import signal
import threading

STOP = threading.Event()
_NUMBERS = (signal.SIGINT, signal.SIGTERM)


def listen_for_signals() -> None:
    """From now on both signals set STOP. Call it before rclpy is imported: that takes half a second.

    `ros2 launch` sends SIGINT after the terminal has sent it already. Those that follow the first are ignored: one that
    came while Python shuts down, where its handlers are gone, would end the process, and launch would say "has died".
    """
    for number in _NUMBERS:
        signal.signal(number, _stop)


def _stop(*_: object) -> None:
    for number in _NUMBERS:  # first: signals that came while STOP is set would nest until the stack ends
        signal.signal(number, signal.SIG_IGN)
    STOP.set()
