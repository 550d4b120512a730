"""Generated kernel modules on disk: their folder, how they are loaded, when compiling is announced."""

import hashlib
import importlib.util
import logging
import os
import sys
import tempfile
from functools import lru_cache
from pathlib import Path
from types import ModuleType

from pneumo_ros.errors import UsageError

_log = logging.getLogger(__name__)


def kernel_folder() -> Path:
    """`$PNEUMO_KERNELS`, else `$ROS_HOME/pneumo_ros/kernels`, else `~/.ros/pneumo_ros/kernels`."""
    chosen = os.environ.get("PNEUMO_KERNELS")
    if chosen:
        return Path(chosen)
    home = os.environ.get("ROS_HOME") or Path(os.path.expanduser("~")) / ".ros"
    return Path(home) / "pneumo_ros" / "kernels"


def _writable_folder() -> Path:
    folder = kernel_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        if os.environ.get("PNEUMO_KERNELS"):
            raise UsageError(
                f"PNEUMO_KERNELS={folder} cannot be written ({error.strerror}); name a writable folder"
            ) from error
        other = Path(tempfile.mkdtemp(prefix="pneumo_kernels_"))
        _log.warning("%s cannot be written; kernels are compiled again in %s", folder, other)
        return other


def _write_once(path: Path, text: str) -> None:
    """Write unless it is there: numba's cache depends on the file's time. A rename never shows readers half a file."""
    if path.exists() and path.read_text() == text:
        return
    with tempfile.NamedTemporaryFile("w", dir=path.parent, suffix=".tmp", delete=False) as file:
        file.write(text)
    os.replace(file.name, path)


@lru_cache(maxsize=64)
def load_kernel(text: str) -> ModuleType:
    """Import the module whose text is given, from the kernel folder; it compiles at first use and is cached on disk."""
    how_compiled = Path(__file__).with_name("jit.py").read_text(encoding="utf-8")
    digest = hashlib.sha256((text + how_compiled).encode()).hexdigest()[:16]
    name = f"pneumo_kernel_{digest}"
    path = _writable_folder() / f"{name}.py"
    _write_once(path, text)
    if not any((path.parent / "__pycache__").glob(f"{name}.*.nbi")):
        _log.info("compiling the plant kernel %s (a few seconds, once)", digest)
    specification = importlib.util.spec_from_file_location(name, path)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module
