"""Write the pages of docs/reference; Sphinx calls it before it reads the sources."""

from pathlib import Path

from . import effects, nodes, verbs


def write(folder: Path) -> None:
    """All pages, into a new or existing `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "verbs.md").write_text(verbs.page() + "\n", encoding="utf-8")
    (folder / "nodes.md").write_text(nodes.page() + "\n", encoding="utf-8")
    (folder / "effects.md").write_text(effects.page(folder / "signatures") + "\n", encoding="utf-8")
