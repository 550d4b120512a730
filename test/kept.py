"""Results of long computations, kept in .cache/outcomes until the code that made them changes."""

import copyreg
import fcntl
import hashlib
import pickle
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import MappingProxyType, ModuleType
from typing import Any

import numba
import numpy as np

from pneumo_ros.plant.kernels import load_kernel

TEST = Path(__file__).parent
PACKAGE = TEST.parent / "pneumo_ros"
FOLDER = TEST.parent / ".cache" / "outcomes"
# what a diagnosis calls; nodes, pages and commands make nothing of it
ROOMS = ("plant", "records", "config", "runs", "equations", "reading", "shooting", "identify", "compare", "diagnose")
MOST = 12  # files, the locks among them


def _proxy(values: dict[Any, Any]) -> MappingProxyType[Any, Any]:
    return MappingProxyType(values)


def _kernel(module: ModuleType) -> tuple[Any, tuple[str]]:
    """A kernel is loaded again from its text."""
    return load_kernel, (Path(module.__file__ or "").read_text(),)


copyreg.pickle(ModuleType, _kernel)
copyreg.pickle(MappingProxyType, lambda proxy: (_proxy, (dict(proxy),)))


@cache
def fingerprint(makers: tuple[Path, ...]) -> str:
    """Hash of the rooms that compute, of the `makers` beside them, and of the libraries' versions."""
    files = [path for room in ROOMS for path in sorted((PACKAGE / room).rglob("*")) if path.suffix in (".py", ".yaml")]
    digest = hashlib.sha256(f"{np.__version__} {numba.__version__}".encode())
    for path in (*files, *makers):
        digest.update(str(path.relative_to(TEST.parent)).encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def kept(name: str, make: Callable[[], Any], *makers: Path) -> Any:
    """What `make` returns, computed once for all processes; `makers` are the files of the tests that it calls."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    path = FOLDER / f"{name}-{fingerprint((Path(__file__), *makers))}.pickle"
    with path.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if path.exists():
            return pickle.loads(path.read_bytes())
        found = make()
        part = path.with_suffix(".part")
        part.write_bytes(pickle.dumps(found))
        part.replace(path)
    for old in sorted(FOLDER.iterdir(), key=lambda one: one.stat().st_mtime, reverse=True)[MOST:]:
        old.unlink(missing_ok=True)
    return found
