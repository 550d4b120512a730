"""The server of the page: on this machine alone, until Ctrl-C."""

import logging
import socket
from collections.abc import Callable

from pneumo_ros.errors import UsageError
from pneumo_ros.workbench.app import make_app
from pneumo_ros.workbench.desk import Given
from pneumo_ros.workbench.desks import Desks
from pneumo_ros.workbench.safety import HOST, Guard

_THREADS = 8  # a browser opens six connections


def serve(given: Given, port: int, ready: Callable[[str], None]) -> None:
    """Serve the page on `port` (0: any free one) until KeyboardInterrupt; `ready` gets the address to open.

    Raises UsageError when the port is taken, and what `Desk` raises for a wrong machine file.
    """
    from waitress.server import create_server

    listening = _listen(port)
    desks = Desks(given)
    try:
        guard = Guard(listening.getsockname()[1])
        desks.prepare()  # a wrong machine file is reported before anybody opens the page
        app = make_app(desks, guard)
        logging.getLogger("waitress.queue").setLevel(logging.ERROR)  # a busy machine is not worth a message
        server = create_server(app.server, sockets=[listening], threads=_THREADS, ident=None)
        ready(guard.address)
        server.run()
    finally:
        listening.close()
        desks.close()


def _listen(port: int) -> socket.socket:
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((HOST, port))
    except OSError as problem:
        listening.close()
        raise UsageError(f"cannot listen on port {port}: {problem.strerror}; --port 0 takes any free port") from problem
    return listening
