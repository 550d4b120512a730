"""A live axis: a watcher beside its nodes reports its signals, a recorder records them. Each is its own process."""

import json
import math
import re
import signal
import subprocess
import sys
import threading
import time
from collections import deque
from pathlib import Path
from typing import Any

from pneumo_ros.environment import require_ros
from pneumo_ros.errors import UsageError
from pneumo_ros.workbench.twin import WINDOW, Twin

KEPT = 20.0  # s that are shown
_RATE = 100  # values a second, at most
_PATIENCE = 10.0  # s, for a node to end
_NAMESPACE = re.compile(r"([A-Za-z_]\w*(/[A-Za-z_]\w*)*)?")
_NAME = re.compile(r"/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*")


class Live:
    """Signals and status of the axis in `namespace` from its watcher; UsageError for a bad name or without ROS."""

    def __init__(self, namespace: str, folder: Path) -> None:
        require_ros()
        if not _NAMESPACE.fullmatch(namespace):
            raise UsageError(f"'{namespace[:60]}' is no namespace; use letters, digits and _, with / between names")
        self.namespace, self.folder = namespace, folder
        self.series: dict[str, deque[tuple[float, float]]] = {}
        self.status: dict[str, dict[str, Any]] = {}
        self.answer = ""
        self.recording: Path | None = None
        self._recorder: subprocess.Popen[bytes] | None = None
        self.twin = Twin(round(KEPT / WINDOW))
        self._began, self._lock = time.time(), threading.Lock()
        self._watcher = subprocess.Popen(
            [sys.executable, "-m", "pneumo_ros.ros.watcher", *self._arguments()], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, start_new_session=True,
        )  # fmt: skip
        threading.Thread(target=self._listen, daemon=True).start()

    def _arguments(self, *more: str) -> list[str]:
        place = ["-r", f"__ns:=/{self.namespace}"] if self.namespace else []
        return ["--ros-args", *place, *more] if place or more else []

    def _listen(self) -> None:
        assert self._watcher.stdout is not None
        for text in self._watcher.stdout:
            line = json.loads(text)
            with self._lock:
                if "answer" in line:
                    self.answer = "Set." if line["successful"] else f"Refused: {line['answer']}"
                self.status |= line.get("status", {})
                for name, values in line.get("series", {}).items():
                    kept = self.series.setdefault(name, deque(maxlen=round(KEPT * _RATE)))
                    kept.extend((at - self._began, value) for at, value in values)

    def curves(self) -> dict[str, tuple[list[float], list[float]]]:
        """Times [s since the start] and values of every series, the last 20 s of them."""
        with self._lock:
            last = max((kept[-1][0] for kept in self.series.values() if kept), default=0.0)
            inside = {n: [p for p in kept if p[0] > last - KEPT] for n, kept in self.series.items()}
        return {name: ([t for t, _ in points], [v for _, v in points]) for name, points in inside.items() if points}

    def set(self, node: str, name: str, value: float) -> None:
        """Ask a node to take a value for a parameter; `answer` says whether it did. UsageError for a bad name."""
        if not _NAME.fullmatch(node) or not math.isfinite(value):
            raise UsageError(f"'{node[:60]}' is not the name of a node, such as simulator")
        whole = node if node.startswith("/") else "/" + "/".join(part for part in (self.namespace, node) if part)
        self.answer = f"asking {whole} ..."
        assert self._watcher.stdin is not None
        self._watcher.stdin.write(json.dumps({"node": whole, "name": name, "value": value}) + "\n")
        self._watcher.stdin.flush()

    def record(self) -> None:
        """Record all topics of the axis into a new folder."""
        if self._recorder is None:
            number = 1 + sum(1 for _ in self.folder.glob("live_*"))
            self.recording = self.folder / f"live_{number}"
            self._recorder = subprocess.Popen(
                [sys.executable, "-m", "pneumo_ros.ros.recorder", *self._arguments("-p", f"output:={self.recording}")],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
            )  # fmt: skip

    def stop_recording(self) -> Path | None:
        """End the recording; its folder, None when nothing was recorded."""
        recorder, self._recorder, path = self._recorder, None, self.recording
        self.recording = None
        if recorder is None:
            return None
        _end(recorder)
        return path if path is not None and path.is_dir() else None

    def close(self) -> None:
        """End both processes."""
        self.stop_recording()
        _end(self._watcher)


def _end(process: "subprocess.Popen[Any]") -> None:
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    try:
        process.wait(_PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
