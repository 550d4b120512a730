"""A shell as a person has it: interactive, at a terminal, with the completion script where the shell looks for it."""

import fcntl
import os
import pty
import re
import select
import subprocess
import sys
import termios
import time
from pathlib import Path

PATIENCE = 60.0  # s, until the shell has answered
_MARKS = re.compile(
    r"\x1b\[[0-9;?<>=]*[a-zA-Z]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)|\x1b[()][A-Z0-9]|\x1b[=>]|[\r\x00\x07\x08]"
)


class LiveShell:
    """A running shell; what it writes is collected, without the marks that move the cursor."""

    def __init__(self, command: list[str], folder: Path) -> None:
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
        environment = {"PATH": path, "HOME": str(folder), "TERM": "xterm", "LANG": "C.UTF-8", "COLUMNS": "200"}
        self._master, slave = pty.openpty()
        self._process = subprocess.Popen(
            command, stdin=slave, stdout=slave, stderr=slave, cwd=folder, env=environment, start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),  # fish wants a terminal of its own
        )  # fmt: skip
        os.close(slave)
        self.said = ""

    def type(self, text: str) -> None:
        """Press these keys."""
        os.write(self._master, text.encode())

    def wait_for(self, text: str) -> None:
        """Wait until the shell has written `text` since the last wait; AssertionError with what it wrote instead."""
        end = time.monotonic() + PATIENCE
        while text not in self.said and time.monotonic() < end:
            if select.select([self._master], [], [], 0.1)[0]:
                self.said += _MARKS.sub("", os.read(self._master, 65536).decode(errors="replace"))
        assert text in self.said, f"'{text}' never came; the shell wrote:\n{self.said}"
        self.said = self.said.partition(text)[2]

    def close(self) -> None:
        """End the shell."""
        self._process.kill()
        self._process.wait(30)
        os.close(self._master)
