"""The answer to a request that fails: one sentence, never a traceback or a page of the web server."""

import logging
import traceback

from flask import Flask, Response, request
from werkzeug.exceptions import HTTPException

_LOG = logging.getLogger(__name__)
_WORDS = 200  # characters of the failure that are shown


def answer_in_words(server: Flask) -> None:
    """Errors of `server` become a line of text: 400 for requests that the page never sends, 500 for failures."""
    server.register_error_handler(HTTPException, _refused)
    server.register_error_handler(Exception, _failed)


def _refused(problem: HTTPException) -> Response:
    return _said(f"{problem.name}: {problem.description or ''}", problem.code or 500)


def _failed(problem: Exception) -> Response:
    """A request that fails before it reaches a panel is malformed; otherwise a panel failed."""
    frames = traceback.extract_tb(problem.__traceback__)
    ours = [f for f in frames if "/pneumo_ros/workbench/" in f.filename.replace("\\", "/")]
    what = f"{type(problem).__name__}: {problem}"[:_WORDS]
    if not ours:
        return _said(f"The page does not send this ({what}); reload it", 400)
    _LOG.error("%s failed at %s:%s: %s", request.path, ours[-1].filename, ours[-1].lineno, what)
    return _said(f"The workbench failed ({what}); its terminal shows where", 500)


def _said(words: str, status: int) -> Response:
    return Response(" ".join(words.split()) + "\n", status, mimetype="text/plain")
