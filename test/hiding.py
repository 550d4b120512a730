"""A Python in which some modules seem to be missing."""

import os
from pathlib import Path

PROGRAM = '''
import sys
from importlib.machinery import PathFinder

HIDDEN = {hidden!r}


class Hiding(PathFinder):
    """Finds nothing of the modules that are to be missing."""

    @classmethod
    def find_spec(cls, name, path=None, target=None):
        top = name.partition(".")[0]
        if top in HIDDEN or (top.endswith(("_msgs", "_srvs", "_interfaces")) and "rclpy" in HIDDEN):
            return None
        return super().find_spec(name, path, target)


sys.meta_path[:] = [Hiding if finder is PathFinder else finder for finder in sys.meta_path]
'''


def environment_without(folder: Path, *modules: str) -> dict[str, str]:
    """Environment for a child Python that does not find `modules`; hiding rclpy hides the messages too.

    The file that hides them is written to `folder`.
    """
    (folder / "sitecustomize.py").write_text(PROGRAM.format(hidden=set(modules)), encoding="utf-8")
    paths = [str(folder), str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))}
