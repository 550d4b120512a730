"""`python test/manual`: how many links, statements and code blocks of the README and the manual the tests follow."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from manual.pages import PAGES, blocks, inline, links, statements
from manual.unrun import ELSEWHERE, first


def main() -> None:
    """Print the counts, and which test runs what is not run here."""
    typed = [one for page in PAGES for one in statements(page)]
    left = [one for one in typed if first(ELSEWHERE, one.text)]
    code = [one for page in PAGES for one in blocks(page) if one.language and not one.shell]
    every = [link for page in PAGES for link in links(page)]
    outside = [link for link in every if link.startswith(("http:", "https:"))]
    print(f"{len(PAGES)} pages")
    print(f"{len(every) - len(outside)} links lead to files and headings that exist; {len(outside)} lead outside")
    print(f"{len(typed) - len(left)} of {len(typed)} command lines are run")
    print(f"{len(left)} are run by another test:")
    for pattern, reason in ELSEWHERE.items():
        count = sum(first({pattern: reason}, one.text) is not None for one in left)
        print(f"  {count:3d}  {pattern:60s} {reason}")
    print(f"{sum(len(inline(page)) for page in PAGES)} commands inside sentences are parsed")
    languages = {one.language for one in code}
    counts = ", ".join(f"{sum(one.language == kind for one in code)} {kind}" for kind in sorted(languages))
    print(f"{len(code)} blocks of code are run or read: {counts}")


if __name__ == "__main__":
    main()
