"""Settings of Sphinx for the manual: `make docs` here, rosdoc2 on a build farm. Nothing is fetched."""

import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent))

project = "pneumo_ros"
author = "pneumo_ros maintainers"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build", "notebooks"]
html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["wide.css"]
html_title = "pneumo_ros"
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 3
suppress_warnings = ["myst.header", "misc.highlighting_failure"]  # shell blocks hold what a terminal shows, too
_OUTSIDE = re.compile(r"(!?)\[([^\]]*)\]\((\.\./[^)]*|notebooks/[^)]*|[^):]*\.gif)\)")


def setup(app: Any) -> None:
    """Write the reference from the code before the sources are read; links out of this folder become text."""
    app.connect("builder-inited", _reference)
    app.connect("source-read", _inside)


def _reference(app: Any) -> None:
    from tools.manual.reference import write

    write(HERE / "reference")


def _inside(app: Any, name: str, source: list[str]) -> None:
    """Files beside the manual are no pages of it: their links become their names."""
    if not name.startswith("reference/"):
        source[0] = _OUTSIDE.sub(lambda found: f"{found[2]} (`{found[3].removeprefix('../')}`)", source[0])
