"""`pneumo commission` in a process of its own: its sentences as they come, and its result."""

import json
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

GRACE = 20.0  # s after SIGINT: the valve is closed, and the recording that is under way is ended
DONE, MEND = 0, 1  # exit codes of the verb: finished; something is to be swapped, or not certain


def command_line(values: Mapping[str, Any], namespace: str, again: int) -> list[str]:
    """The verb and its options for the parameters of the node; `again`: how often plugs have been mended before.

    What was recorded with wrong plugs stays; the recordings after it go to another folder.
    """
    stem = Path(values["output"]).with_suffix("")
    words = ["commission", "--out", values["output"], "--overwrite", "--json", "-"]
    words += ["--folder", f"{stem}_runs" + (f"_{again + 1}" if again else "")]
    named = {
        "--model": values["model"], "--rig": values["rig"], "--read-as": values["read_as"],
        "--closed": values["closed_signal"], "--sensors": values["sensors"], "--namespace": namespace,
        "--report": values["report"], "--joint": values["joint_name"],
    }  # fmt: skip
    words += [part for option, value in named.items() if value for part in (option, value)]
    words += ["--as-wired"] if values["as_wired"] else []
    words += ["--stage", "0"] if values["stage"] == 0 else []
    words += ["--minutes", f"{values['minutes']:g}", "--evaluations", str(values["evaluations"])]
    return [*words, "--timeout", f"{1e3 * values['measurement_timeout']:g}"]


class Job:
    """One call of the verb. `told` gets each sentence, `ended` exit code and result, both in a thread of their own."""

    def __init__(
        self, arguments: Sequence[str], told: Callable[[str], None], ended: Callable[[int, dict[str, Any]], None]
    ) -> None:
        self._told, self._ended = told, ended
        self._process = subprocess.Popen(
            [sys.executable, "-m", "pneumo_ros", *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True,
        )  # fmt: skip
        self._out: list[str] = []
        self._thread = threading.Thread(target=self._run, name="commission", daemon=True)
        self._thread.start()

    @property
    def busy(self) -> bool:
        """Whether it still runs."""
        return self._thread.is_alive()

    def stop(self) -> None:
        """Interrupt it as Ctrl-C does: the valve is closed first."""
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(GRACE)
            except subprocess.TimeoutExpired:
                self._process.kill()  # the node that moves the plant notices, and closes the valve
        self._thread.join(GRACE)

    def _run(self) -> None:
        process = self._process
        assert process.stdout is not None
        assert process.stderr is not None
        reader = threading.Thread(target=self._read, args=(process.stdout,), daemon=True)
        reader.start()
        for line in process.stderr:
            if line.strip():
                self._told(line.strip())
        code = process.wait()
        reader.join(GRACE)
        self._ended(code, result_of("".join(self._out)))

    def _read(self, stream: Any) -> None:
        self._out += list(stream)


def result_of(text: str) -> dict[str, Any]:
    """The JSON that the verb has printed, empty where it failed before."""
    try:
        found = json.loads(text)
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}
