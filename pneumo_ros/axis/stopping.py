"""SIGINT and SIGTERM request the end; rclpy's own handlers would end its context before the last messages are sent."""

import signal
import threading

STOP = threading.Event()


def listen_for_signals() -> None:
    """From now on both signals set STOP. Call it before rclpy is imported: that takes half a second."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: STOP.set())
