"""Access to the page: only from this machine, with the printed address, and from the page itself.

Any page in the same browser can send requests to 127.0.0.1, and can give that address another name. Three checks
therefore come first: the Host of the request, its Origin, and a token.
"""

import hmac
import secrets
from collections.abc import Callable, Sequence
from urllib.parse import urlsplit

from flask import Flask, Response, redirect, request
from werkzeug.wrappers import Response as AnyResponse

HOST = "127.0.0.1"
_NAMES = (HOST, "localhost")
_ADVICE = "open the address that 'pneumo workbench' printed, with its token"


class Guard:
    """The checks of one server, and the cookie that keeps the token after the first request."""

    def __init__(self, port: int, token: str | None = None) -> None:
        self.port, self.token = port, token or secrets.token_urlsafe(24)
        self.cookie = f"pneumo_workbench_{port}"  # cookies are shared by all ports

    @property
    def address(self) -> str:
        """The address to open in a browser."""
        return f"http://{HOST}:{self.port}/?token={self.token}"

    def protect(self, server: Flask, begin: Callable[[], str], scripts: Sequence[str]) -> None:
        """Check every request to `server`; a right token is redirected to `begin()`.

        `scripts`: hashes of the scripts inside the page, in the form of a policy.
        """
        policy = _policy(scripts)

        def check() -> AnyResponse | None:
            problem = self._foreign()
            if problem:
                return _refused(problem)
            if request.path == "/" and "token" in request.args:
                return self._enter(begin)
            if not self._known(request.cookies.get(self.cookie)):
                return _refused(f"this page needs its token: {_ADVICE}")
            return redirect(begin(), 303) if request.path == "/" else None

        def seal(response: Response) -> Response:
            response.headers["Content-Security-Policy"] = policy
            response.headers["X-Content-Type-Options"] = "nosniff"
            response.headers["Referrer-Policy"] = "same-origin"
            response.headers["Cross-Origin-Resource-Policy"] = "same-origin"
            return response

        server.before_request(check)
        server.after_request(seal)

    def _foreign(self) -> str:
        """Why a request is foreign; empty when it is not."""
        hosts = [f"{name}:{self.port}" for name in _NAMES]
        if request.host not in hosts:
            return f"this server does not answer to the name {request.host[:80]!r}: {_ADVICE}"
        origin = request.headers.get("Origin")
        if origin is not None and (urlsplit(origin).scheme != "http" or urlsplit(origin).netloc not in hosts):
            return "another page may not talk to this server"
        if request.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin") and request.method != "GET":
            return "another page may not talk to this server"
        return ""

    def _known(self, given: str | None) -> bool:
        return given is not None and hmac.compare_digest(given.encode(), self.token.encode())

    def _enter(self, begin: Callable[[], str]) -> AnyResponse:
        if not self._known(request.args["token"]):
            return _refused(f"wrong token: {_ADVICE}")
        response = redirect(begin(), 303)
        response.set_cookie(self.cookie, self.token, httponly=True, samesite="Strict")
        return response


def _refused(why: str) -> Response:
    return Response(f"Refused: {why}.\n", 403, mimetype="text/plain")


def _policy(scripts: Sequence[str]) -> str:
    """Nothing is fetched from elsewhere, nobody frames the page, and scripts run by their hash or from this server."""
    return (
        f"default-src 'none'; script-src 'self' {' '.join(scripts)}; style-src 'self' 'unsafe-inline'; "
        "img-src 'self' data: blob:; font-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    )
