"""One job at a time in a process of its own, which reports line by line."""

import json
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping
from typing import Any

PROGRAM = "pneumo_ros.axis.identification.work"
GRACE = 2.0  # s, for the process to end after SIGTERM

Line = Mapping[str, Any]


class Worker:
    """Starts jobs; `told` is called, in a thread, with every line, the last one being `result` or `failed`."""

    def __init__(self, told: Callable[[Line], None]) -> None:
        self._told = told
        self._process: subprocess.Popen[str] | None = None
        self._thread: threading.Thread | None = None
        self._stopped = False

    @property
    def busy(self) -> bool:
        """Whether a job is under way."""
        return self._thread is not None and self._thread.is_alive()

    def start(self, job: Mapping[str, Any]) -> None:
        """Begin a job; there must be none under way. Signals from a terminal do not reach the process."""
        self._thread = threading.Thread(target=self._work, args=(json.dumps(job),), name="worker", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End the process of a job under way; it reports nothing more."""
        self._stopped = True
        process, thread = self._process, self._thread
        if process is not None and process.poll() is None:
            process.terminate()
            try:
                process.wait(GRACE)
            except subprocess.TimeoutExpired:
                process.kill()
        if thread is not None:
            thread.join(GRACE)

    def _work(self, job: str) -> None:
        with tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as complaints:
            process = subprocess.Popen(
                [sys.executable, "-m", PROGRAM],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=complaints, text=True, start_new_session=True,
            )  # fmt: skip
            self._process = process
            last = self._listen(process, job)
            code = process.wait()
            if not self._stopped and not {"result", "failed"} & last.keys():
                complaints.seek(0)
                words = complaints.read().strip().splitlines()
                said = words[-1] if words else "no output"
                self._told({"failed": f"the work ended unexpectedly with exit code {code}: {said}"})

    def _listen(self, process: "subprocess.Popen[str]", job: str) -> Line:
        """Send the job and pass on every line; returns the last one."""
        assert process.stdin is not None
        assert process.stdout is not None
        last: Line = {}
        try:
            process.stdin.write(job)
            process.stdin.close()
        except BrokenPipeError:  # it could not even start; its stderr says why
            return last
        for text in process.stdout:
            last = json.loads(text)
            if not self._stopped:
                self._told(last)
        return last
