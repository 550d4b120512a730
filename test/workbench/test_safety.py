"""Access to the workbench: only with its token, from its own page, under its own name; and the files it sends."""

from http.client import HTTPConnection, HTTPResponse
from urllib.parse import quote

import pytest
from workbench.conftest import Served


def ask(served: Served, path: str, method: str = "GET", body: bytes | None = None, **headers: str) -> HTTPResponse:
    """The answer to one request."""
    connection = HTTPConnection("127.0.0.1", served.port, timeout=20)
    words = {name.replace("_", "-"): value for name, value in headers.items()}
    connection.request(method, path, body, words)
    answer = connection.getresponse()
    answer.body = answer.read()  # type: ignore[attr-defined]  # kept for the test
    connection.close()
    return answer


def cookie(served: Served) -> str:
    """The cookie in exchange for the right token."""
    return str(ask(served, f"/?token={served.token}").headers["Set-Cookie"])


def known(served: Served) -> str:
    """A Cookie header that is accepted."""
    return cookie(served).partition(";")[0]


def desk(served: Served) -> str:
    """The identifier of a new desk."""
    return ask(served, f"/?token={served.token}").headers["Location"].rpartition("/")[2]


PATHS = ("/", "/b/0123456789ab", "/_dash-layout", "/_dash-dependencies", "/report/plots.js", "/assets/workbench.js")


@pytest.mark.parametrize("path", PATHS)
def test_nothing_is_sent_without_the_token(served: Served, path: str) -> None:
    assert ask(served, path).status == 403
    assert ask(served, path, Cookie=f"pneumo_workbench_{served.port}=wrong").status == 403


@pytest.mark.parametrize("token", ["", "wrong", "%00", "\u00fc"])
def test_a_wrong_token_is_refused(served: Served, token: str) -> None:
    answer = ask(served, f"/?token={quote(token)}")
    assert answer.status == 403
    assert b"wrong token" in answer.body
    assert "Set-Cookie" not in answer.headers


def test_the_right_token_leads_to_a_desk_and_stays_in_a_cookie_no_script_sees(served: Served) -> None:
    answer = ask(served, f"/?token={served.token}")
    assert answer.status == 303
    assert answer.headers["Location"].startswith("/b/")
    assert "HttpOnly" in cookie(served)
    assert "SameSite=Strict" in cookie(served)
    assert ask(served, answer.headers["Location"], Cookie=known(served)).status == 200


def test_the_address_of_a_desk_that_no_longer_exists_leads_to_a_new_one(served: Served) -> None:
    answer = ask(served, "/b/000000000000", Cookie=known(served))
    assert (answer.status, answer.headers["Location"]) == (303, "/")


@pytest.mark.parametrize("host", ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "[::1]:{port}"])
def test_a_foreign_host_is_refused(served: Served, host: str) -> None:
    answer = ask(served, f"/?token={served.token}", Host=host.format(port=served.port))
    assert answer.status == 403
    assert "Set-Cookie" not in answer.headers


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "http://127.0.0.1:1", "https://127.0.0.1:{port}"])
def test_a_foreign_origin_is_refused(served: Served, origin: str) -> None:
    headers = {"Cookie": known(served), "Origin": origin.format(port=served.port), "Content-Type": "application/json"}
    assert ask(served, "/_dash-update-component", "POST", b"{}", **headers).status == 403
    assert ask(served, f"/upload/{desk(served)}/a.mcap", "PUT", b"x", **headers).status == 403


def test_a_request_of_another_site_is_refused(served: Served) -> None:
    headers = {"Cookie": known(served), "Sec-Fetch-Site": "cross-site"}
    assert ask(served, f"/upload/{desk(served)}/a.mcap", "PUT", b"x", **headers).status == 403


def test_the_page_may_load_from_nowhere_else(served: Served) -> None:
    policy = ask(served, f"/b/{desk(served)}", Cookie=known(served)).headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "frame-ancestors 'none'" in policy
    assert "http" not in policy
    assert "unsafe" not in policy.partition("style-src")[0]


ESCAPES = ("../x.mcap", "a/../../x.mcap", "..%2f..%2fx.mcap", ".hidden.mcap", "a/%2e%2e/b.mcap", "x.sh",
           "x.mcap%00.txt", "caf%C3%A9.mcap", "C:%5Cx.py")  # fmt: skip


@pytest.mark.parametrize("name", ESCAPES)
def test_an_upload_that_would_leave_its_folder_is_refused(served: Served, name: str) -> None:
    assert ask(served, f"/upload/{desk(served)}/{name}", "PUT", b"x", Cookie=known(served)).status == 400


def test_an_upload_to_no_desk_and_one_too_large_are_refused(served: Served) -> None:
    assert ask(served, "/upload/000000000000/a.mcap", "PUT", b"x", Cookie=known(served)).status == 404
    huge = {"Cookie": known(served), "Content-Length": str(3 * 1024**3)}
    assert ask(served, f"/upload/{desk(served)}/a.mcap", "PUT", b"x", **huge).status == 413


@pytest.mark.parametrize("name", ["paper.yaml", "..", "made_1.json", "uploads"])
def test_only_what_is_offered_is_sent(served: Served, name: str) -> None:
    """The file of the current machine is; that of another shipped one is not."""
    assert ask(served, f"/files/{desk(served)}/axis.yaml", Cookie=known(served)).status == 200
    assert ask(served, f"/files/{desk(served)}/{name}", Cookie=known(served)).status == 404
    outside = ask(served, f"/files/{desk(served)}/..%2f..%2f..%2fetc%2fpasswd", Cookie=known(served))
    assert b"root:" not in outside.body


@pytest.mark.parametrize("body", ["[]", "{}", '{"output": 3}', '{"output": "a.b", "inputs": 1}', "null", '"x"', "{"])
def test_what_the_page_never_sends_is_answered_in_words(served: Served, body: str) -> None:
    headers = {"Cookie": known(served), "Content-Type": "application/json"}
    answer = ask(served, "/_dash-update-component", "POST", body.encode(), **headers)
    assert answer.status == 400
    assert answer.headers["Content-Type"].startswith("text/plain")
    assert b"Traceback" not in answer.body
    assert b"<html" not in answer.body
