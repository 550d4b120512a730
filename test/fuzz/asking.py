"""Requests to the workbench: a request as a file, and the server that answers it within this process."""

import json
from functools import lru_cache
from pathlib import Path
from typing import Any
from urllib.parse import quote

from flask import Flask
from hypothesis import strategies as st
from werkzeug.test import Client, EnvironBuilder

from fuzz.mutation import mutated
from pneumo_ros.errors import UsageError
from pneumo_ros.workbench.app import make_app
from pneumo_ros.workbench.desk import Given
from pneumo_ros.workbench.desks import Desks
from pneumo_ros.workbench.safety import Guard

PORT, TOKEN = 8050, "a-token-of-the-tests"
KNOWN = f"Host: 127.0.0.1:{PORT}\nCookie: pneumo_workbench_{PORT}={TOKEN}\n"
CALLBACK = "..variants.children.."  # shows names: no request to it starts a job


@lru_cache(1)
def served() -> tuple[Client, str, dict[str, Any]]:
    """The workbench without recordings, one of its desks, and the page's request for the machine's name."""
    desks, guard = Desks(Given()), Guard(PORT, TOKEN)
    app = make_app(desks, guard)
    app._setup_server()  # as Dash does at the first request
    callback = app.callback_map[CALLBACK]
    desk = desks.new()
    inputs, state = (
        [{**one, "value": f"/b/{desk}" if one["id"] == "url" else 0} for one in callback[part]]
        for part in ("inputs", "state")
    )
    sent = {
        "output": CALLBACK, "outputs": [{"id": "variants", "property": "children"}], "inputs": inputs, "state": state,
        "changedPropIds": [f"{inputs[0]['id']}.{inputs[0]['property']}"],
    }  # fmt: skip
    server: Flask = app.server
    return Client(server, use_cookies=False), desk, sent


def ask(path: Path) -> None:
    """Send the request in the file: METHOD PATH, headers, an empty line, the body.

    Raises UsageError with the text of a refusal; status 500 means a traceback and is not a refusal.
    """
    client, _, _ = served()
    head, _, body = path.read_bytes().partition(b"\n\n")
    first, *lines = head.decode("latin-1").split("\n")
    method, _, target = first.partition(" ")
    headers = [(name.strip(), value.strip()) for name, mark, value in (line.partition(":") for line in lines) if mark]
    try:
        request = EnvironBuilder(path=quote(target, "/?=&%"), method=method, headers=headers, data=body)
    except (ValueError, UnicodeError) as problem:  # no HTTP: the parser of the server (waitress) would not pass it on
        raise UsageError(f"not a request at all: {problem}"[:300]) from problem
    answer = client.open(request)
    words = answer.get_data(as_text=True)
    assert answer.status_code < 500, words[:500]
    if answer.status_code >= 400:
        raise UsageError(f"{answer.status_code}: {words.strip()}")


def requests() -> list[bytes]:
    """Requests as the page and its visitors send them."""
    _, desk, sent = served()
    callback = f"POST /_dash-update-component\n{KNOWN}Content-Type: application/json\n\n{json.dumps(sent)}"
    plain = [f"/?token={TOKEN}", "/", f"/b/{desk}", "/_dash-layout", "/_dash-dependencies", "/report/plots.js"]
    upload = f"PUT /upload/{desk}/run/bag.mcap\n{KNOWN}\nno recording"
    return [text.encode() for text in (callback, upload, *(f"GET {path}\n{KNOWN}\n" for path in plain))]


def inputs() -> st.SearchStrategy[bytes]:
    """Damaged requests, and callbacks with values of the wrong kind."""
    return mutated(requests()) | st.builds(_callback, st.recursive(LEAVES, _nested, max_leaves=6), st.integers(0, 7))


def _nested(inner: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3)


LEAVES: st.SearchStrategy[Any] = (
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20) | st.sampled_from([CALLBACK, "url"])
)


def _callback(value: Any, where: int) -> bytes:
    """The callback with one part of what it sends replaced, or all of it."""
    _, _, sent = served()
    spoilt = [{**sent, key: value} for key in sent]
    spoilt += [{**sent, part: [{**sent[part][0], "value": value}]} for part in ("inputs", "state")]
    body = json.dumps([*spoilt, value][where])
    return f"POST /_dash-update-component\n{KNOWN}Content-Type: application/json\n\n{body}".encode()
