"""The C compiler of this computer, and the shared library of a functional mock-up unit."""

import os
import platform
import shlex
import shutil
import subprocess
import tempfile
from pathlib import Path

from pneumo_ros.errors import PneumoError, UsageError

FLAGS = ("-std=c99", "-O3", "-fno-math-errno", "-fvisibility=hidden", "-fPIC", "-shared")
_SYSTEMS = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib"), "windows": ("win", ".dll")}
_BOUND = 300.0  # s, for the compiler


def compiler() -> list[str]:
    """$CC, else cc, gcc or clang; UsageError that says what to install."""
    chosen = shlex.split(os.environ.get("CC", ""))
    for words in [chosen] if chosen else [["cc"], ["gcc"], ["clang"]]:
        if shutil.which(words[0]):
            return words
    missing = f"CC is {chosen[0]}, which is not found" if chosen else "there is no C compiler (cc, gcc, clang)"
    raise UsageError(
        f"{missing}; an FMU carries a compiled library. Type: sudo apt install gcc (or set CC); "
        "pneumo export c needs none"
    )


def binary_path(prefix: str, version: int) -> str:
    """Where the library of this computer lies in an FMU, such as binaries/x86_64-linux/axis.so."""
    system, ending = _SYSTEMS.get(platform.system().lower(), ("linux", ".so"))
    architecture = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine().lower())
    name = "windows" if system == "win" else system
    folder = f"{architecture}-{name}" if version == 3 else f"{system}64"
    return f"binaries/{folder}/{prefix}{ending}"


def shared_library(sources: dict[str, str], main: str) -> bytes:
    """Compile `main`, which includes the other files; UsageError without a compiler, PneumoError where it fails."""
    words = compiler()
    with tempfile.TemporaryDirectory(prefix="pneumo_fmu_") as name:
        folder = Path(name)
        for file, text in sources.items():
            (folder / file).write_text(text, encoding="utf-8")
        command = [*words, *FLAGS, main, "-o", "library", "-lm"]
        try:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=_BOUND)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise PneumoError(f"{words[0]} did not run to its end ({error}); type: {words[0]} --version") from error
        if done.returncode != 0:
            first = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr[:200])
            raise PneumoError(f"{words[0]} failed: {first}; another compiler: CC=clang pneumo export fmu ...")
        return (folder / "library").read_bytes()
