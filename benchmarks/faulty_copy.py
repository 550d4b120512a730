"""A copy of a checkout that gets one fault at a time, and its tests with a time limit."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

PASSED, UNKNOWN, NOTHING_CHOSEN, TIME_IS_UP = 0, 4, 5, -1  # exit codes of pytest, and one more
_FIRST = re.compile(r"^(?:FAILED|ERROR) (\S+?\.py(?:::.*?)?)(?: - .*)?$", re.MULTILINE)
_UNSEARCHED = ("test/", "benchmarks/")  # faults are made in what is tested


class Ran(NamedTuple):
    """One call of pytest: its exit code or TIME_IS_UP, the first test that failed, and seconds."""

    code: int
    failed: str
    seconds: float


class FaultyCopy:
    """The tracked files of `tree` at its commit, below `place`; `tree` itself is only read."""

    def __init__(self, tree: Path, place: Path, options: Sequence[str]) -> None:
        """`options` go to every pytest. Raises CalledProcessError when `tree` is no checkout."""
        self.folder, self._place, self._options = place / "tree", place, tuple(options)
        self.commit = _git(tree, "rev-parse", "HEAD").decode().strip()
        self.folder.mkdir(parents=True)
        subprocess.run(["tar", "-x", "-C", self.folder], input=_git(tree, "archive", "HEAD"), check=True)
        self._sound: dict[str, bool] = {}
        if (compiled := tree / ".cache" / "kernels").exists():  # by the tests of that tree: saves compiling them again
            shutil.copytree(compiled, self._kernels())

    def place_of(self, wordings: Sequence[str]) -> tuple[Path, str]:
        """The file with one of `wordings`, and that wording. LookupError unless it occurs exactly once."""
        for text in wordings:
            found = [(path, path.read_text(encoding="utf-8").count(text)) for path in self._searched()]
            count = sum(times for _, times in found)
            if count == 1:
                return next(path for path, times in found if times), text
        raise LookupError(f"occurs {count} times")

    def _searched(self) -> list[Path]:
        names = (path for path in self.folder.rglob("*") if path.is_file() and path.suffix in _TEXTS)
        inside = (path for path in names if not path.relative_to(self.folder).as_posix().startswith(_UNSEARCHED))
        return [path for path in inside if path.resolve() == path and ".cache" not in path.parts]

    def existing(self, patterns: Sequence[str]) -> list[str]:
        """Tests that the patterns name, in that order, each once."""
        paths = [path for pattern in patterns for path in sorted(self.folder.glob(pattern))]
        wanted = (path for path in paths if path.is_dir() or path.name.startswith("test_"))
        return list(dict.fromkeys(path.relative_to(self.folder).as_posix() for path in wanted))

    def faulty(self, path: Path, text: str, instead: str, tests: Sequence[str], seconds: float) -> Ran:
        """Run `tests` with `text` in `path` replaced; the file is as before afterwards."""
        before, state = path.read_text(encoding="utf-8"), path.stat()
        path.write_text(before.replace(text, instead), encoding="utf-8")
        try:
            # kernels compiled from faulty effects must not be found by later runs
            with_fault = path.is_relative_to(self.folder / "pneumo_ros" / "plant")
            return self._pytest(tests, seconds, self._kernels_apart() if with_fault else self._kernels())
        finally:
            path.write_text(before, encoding="utf-8")
            os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))

    def sound(self, test: str, seconds: float) -> bool:
        """Whether a test passes without the fault; otherwise its failure proves nothing.

        A parametrized case that exists only with the fault is judged by the test's existing cases.
        """
        if test not in self._sound:
            code = self._pytest([test], seconds, self._kernels()).code
            if code == UNKNOWN and "[" in test:
                code = self._pytest([test.partition("[")[0]], seconds, self._kernels()).code
            self._sound[test] = code == PASSED
        return self._sound[test]

    def _kernels(self) -> Path:
        return self._place / "kernels"

    def _kernels_apart(self) -> Path:
        apart = self._place / "faulty_kernels"
        shutil.rmtree(apart, ignore_errors=True)
        if self._kernels().exists():
            shutil.copytree(self._kernels(), apart)
        return apart

    def _pytest(self, tests: Sequence[str], seconds: float, kernels: Path) -> Ran:
        options = ["-x", "-q", "--tb=no", "-p", "no:cacheprovider", f"--basetemp={self._place / 'tmp'}"]
        environment = os.environ | {"PYTHONPATH": str(self.folder), "PNEUMO_KERNELS": str(kernels)}
        begin = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, "-m", "pytest", *options, *self._options, *tests],
            cwd=self.folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            start_new_session=True,
        )  # fmt: skip
        try:
            said, _ = process.communicate(timeout=seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return Ran(TIME_IS_UP, "", time.perf_counter() - begin)
        first = _FIRST.search(said)
        return Ran(process.returncode, first[1] if first else said[-200:], time.perf_counter() - begin)


_TEXTS = (".py", ".md", ".rst", ".toml", ".cfg", ".xml", ".yaml", ".xacro", ".js", ".css")


def _git(tree: Path, *words: str) -> Any:
    return subprocess.run(["git", "-C", tree, *words], check=True, stdout=subprocess.PIPE).stdout
