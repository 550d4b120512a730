"""Faults in the workbench: killed, ended, stopped, invalid requests, damaged recordings and a full disk."""

import re
import signal
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http.client import HTTPConnection
from pathlib import Path
from typing import Any, NamedTuple

from fuzz.mutation import mutate
from fuzz.recordings import mcap_seeds
from ros.processes import Running, running

from chaos.disks import small_disk
from chaos.field import ANSWER, Field, hold
from chaos.processes import PAUSE

MANY = 40  # connections that are opened and never send anything


class Answer(NamedTuple):
    """Status and body of an answer, and where it leads."""

    status: int
    body: bytes
    leads: str


class Page:
    """A workbench in a process of its own, and one desk of it."""

    def __init__(self, process: Running) -> None:
        process.wait_for("token=")
        found = re.search(r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)", process.said)
        assert found, process.said
        self.process, self.port, self.token = process, int(found[1]), found[2]
        self.desk = self.ask(f"/?token={self.token}").leads

    @property
    def uploads(self) -> str:
        """Address to which its desk accepts recordings."""
        return f"/upload/{self.desk.rpartition('/')[2]}"

    def ask(self, path: str, method: str = "GET", body: bytes | None = None) -> Answer:
        """Its answer to a request with the token."""
        connection = HTTPConnection("127.0.0.1", self.port, timeout=ANSWER)
        try:
            connection.request(method, path, body, {"Cookie": f"pneumo_workbench_{self.port}={self.token}"})
            answer = connection.getresponse()
            return Answer(answer.status, answer.read(), answer.headers.get("Location", ""))
        finally:
            connection.close()

    def shown(self) -> None:
        """It runs, its desk exists, and no request has failed."""
        hold(self.process.process.poll() is None, f"the workbench ended: {self.process.said[-500:]}")
        answer = self.ask(self.desk)
        hold(answer.status == 200 and b"<html" in answer.body.lower(), f"its desk: {answer.status}")
        hold("Traceback" not in self.process.said, self.process.said[-1000:])


@contextmanager
def page(field: Field, *bags: Path, **variables: str) -> Iterator[Page]:
    """A workbench with `bags`; it ends well, unless it was killed."""
    command = ("-m", "pneumo_ros", "workbench", "--port", "0", *map(str, bags))
    with running(*command, cwd=field.folder, **variables) as process:
        opened = Page(process)
        opened.shown()
        yield opened
        if process.process.poll() is None:
            code = process.end(field.random.choice((signal.SIGINT, signal.SIGTERM)))
            hold(code == 0, f"the workbench ended with {code}: {process.said[-500:]}")


def kill_workbench(field: Field) -> None:
    """kill -9 during an upload: the nodes are not affected, and the next workbench finds its recordings again."""
    bag = field.folder / "shown.mcap"
    bag.write_bytes(mcap_seeds()[0])
    with page(field, bag) as first, _begun(first):
        first.process.process.kill()
        first.process.process.wait(ANSWER)
    hold(bag.read_bytes() == mcap_seeds()[0], "a recording was changed")
    with page(field, bag) as second:
        hold(second.token != first.token, "two workbenches with one token")


@contextmanager
def _begun(shown: Page) -> Iterator[None]:
    """An upload that is half sent."""
    with socket.create_connection(("127.0.0.1", shown.port), timeout=ANSWER) as line:
        head = f"PUT {shown.uploads}/half.mcap HTTP/1.1\r\nHost: 127.0.0.1:{shown.port}\r\nContent-Length: 1000000\r\n"
        cookie = f"Cookie: pneumo_workbench_{shown.port}={shown.token}\r\n\r\n"
        line.sendall((head + cookie).encode() + bytes(500_000))
        yield


def stopped_workbench(field: Field) -> None:
    """Stopped for a while, as by a debugger: it answers afterwards."""
    with page(field) as opened:
        opened.process.process.send_signal(signal.SIGSTOP)
        time.sleep(PAUSE)
        opened.process.process.send_signal(signal.SIGCONT)
        opened.shown()


def rubbish_on_the_line(field: Field) -> None:
    """Bytes that are no request, endless lines, aborted uploads, many silent connections."""
    with page(field) as opened:
        request = f"GET {opened.desk} HTTP/1.1\r\nHost: 127.0.0.1:{opened.port}\r\n\r\n".encode()
        sent = [field.random.randbytes(4000), b"GET " + b"a" * 300_000, b"\0" * 1000, b"PUT / HTTP/1.1\r\n" * 1000]
        sent += [mutate(request, 4, field.random.getrandbits(32)) for _ in range(20)]
        lines = [socket.create_connection(("127.0.0.1", opened.port), timeout=ANSWER) for _ in range(MANY)]
        for line, data in zip(lines, sent, strict=False):
            with suppress(OSError):  # it may close the connection early
                line.sendall(data)
        with _begun(opened):
            pass
        opened.shown()
        for line in lines:
            line.close()
        opened.shown()


def damaged_recordings(field: Field) -> None:
    """Recordings with random bytes changed, given and dropped: shown, or refused with a message."""
    damaged = [
        mutate(field.random.choice(mcap_seeds()), field.random.randrange(1, 6), field.random.getrandbits(32))
        for _ in range(3)
    ]
    given = field.folder / "given.mcap"
    given.write_bytes(damaged.pop())
    with page(field, given) as opened:
        for number, data in enumerate(damaged):
            answer = opened.ask(f"{opened.uploads}/run_{number}/bag.mcap", "PUT", data)
            hold(answer.status in (204, 400), f"an upload: {answer.status} {answer.body[:200]!r}")
        opened.shown()


def full_disk_workbench(field: Field) -> None:
    """The disk fills with uploads: refused with a message, no partial file, and the page continues."""
    with small_disk(field.folder, 4 << 20) as disk, page(field, TMPDIR=str(disk)) as opened:
        statuses = []
        for number in range(12):
            answer = opened.ask(f"{opened.uploads}/run_{number}/bag.mcap", "PUT", bytes(1 << 20))
            statuses.append(answer.status)
            hold(answer.status in (204, 400, 507), f"an upload: {answer.status} {answer.body[:200]!r}")
            hold(answer.status == 204 or len(answer.body) > 20, "an upload was refused without a word")
        hold({204} < set(statuses), f"uploads of 12 MB on a disk of 4 MB: {statuses}")
        whole = sorted(path.stat().st_size for path in disk.rglob("bag.mcap"))
        hold(whole == [1 << 20] * statuses.count(204), f"kept: {whole}")
        hold(not list(disk.rglob("*.part")), "half a file was kept")
        opened.shown()


PAGES: dict[str, Callable[[Field], Any]] = {
    "kill -9 of the workbench": kill_workbench,
    "SIGSTOP of the workbench": stopped_workbench,
    "rubbish sent to the workbench": rubbish_on_the_line,
    "workbench of damaged recordings": damaged_recordings,
}
FULL: dict[str, Callable[[Field], Any]] = {"disk full of uploads": full_disk_workbench}
