"""What the README and the pages of docs/ hold: shell statements, code, links; cut out as a reader would copy them."""

import re
import shlex
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
SHELLS = ("sh", "shell", "bash", "console")
_BLOCK = re.compile(r"^```([\w{}-]*)[^\n]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_WORDED = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)\s]+)\)")
_INLINE = re.compile(r"`((?:pneumo [a-z]|make [a-z]|python [a-z])[^`]*)`")


class Block(NamedTuple):
    """A fenced block: its page, its number there from 0, its language (maybe none), and its text."""

    page: Path
    number: int
    language: str
    text: str

    @property
    def shell(self) -> bool:
        """Whether a shell reads it: all of it, or the lines that begin with `$ `."""
        return self.language in SHELLS or any(line.startswith("$ ") for line in self.text.splitlines())


class Statement(NamedTuple):
    """What is typed at once: one line, with its continuations and quotes closed; `$ ` and comments cut off."""

    page: Path
    block: int
    text: str

    @property
    def id(self) -> str:
        """Page, block and the first words."""
        begin = "_".join(re.findall(r"[-.\w]+", self.text)[:4])
        return f"{self.page.name}-{self.block}-{begin}"


def blocks(page: Path) -> list[Block]:
    """The fenced blocks of a page, in order."""
    found = _BLOCK.findall(page.read_text(encoding="utf-8"))
    return [Block(page, k, language, text) for k, (language, text) in enumerate(found)]


def statements(page: Path) -> list[Statement]:
    """Everything that a page gives to type, in order."""
    return [Statement(page, one.number, text) for one in blocks(page) if one.shell for text in _typed(one)]


def _typed(block: Block) -> list[str]:
    """The statements of a shell block."""
    lines = block.text.replace("\\\n", " ").splitlines()
    if block.language not in SHELLS:
        lines = [line[2:] for line in lines if line.startswith("$ ")]
    found, begun = list[str](), ""
    for line in lines:
        begun += ("\n" if begun else "") + line.removeprefix("$ ")
        if _closed(begun):
            found, begun = [*found, without_comment(begun)], ""
    assert not begun, f"{block.page.name}: a quote is not closed: {begun}"
    return [one for one in found if one.strip()]


def _closed(text: str) -> bool:
    try:
        shlex.split(text, comments=True)
    except ValueError:
        return False
    return True


def without_comment(text: str) -> str:
    """A line without its comment; a statement of several lines as it is."""
    return text if "\n" in text else re.sub(r"(^|\s+)#\s.*$", "", text).rstrip()


def inline(page: Path) -> list[str]:
    """Commands inside sentences, in backticks, outside of blocks."""
    return [" ".join(one.split()) for one in _INLINE.findall(_BLOCK.sub("", page.read_text(encoding="utf-8")))]


def links(page: Path) -> list[str]:
    """Where a page's links and pictures lead, without the blocks."""
    return _LINK.findall(_BLOCK.sub("", page.read_text(encoding="utf-8")))


def worded_links(page: Path) -> list[tuple[str, str]]:
    """The text of each link and where it leads, without pictures and blocks."""
    found = _WORDED.findall(_BLOCK.sub("", page.read_text(encoding="utf-8")))
    return [(" ".join(text.split()), target) for text, target in found]


def words(line: str) -> list[str]:
    """The arguments as a shell gives them; what follows a pipe, a redirection or && belongs to others."""
    lexer = shlex.shlex(line, posix=True, punctuation_chars=True)
    lexer.whitespace_split = True
    given = list(lexer)
    ends = [k for k, word in enumerate(given) if word in ("|", ">", ">>", "&&", "&", ";", "<")]
    return given[: min(ends, default=len(given))]


def heading_names(page: Path) -> set[str]:
    """The anchors that GitHub and the manual give to the headings of a page."""
    text = _BLOCK.sub("", page.read_text(encoding="utf-8"))
    titles = re.findall(r"^#{1,6} (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", "-") for title in titles}
