"""`python test/manual`: how many links, statements and code blocks of the README and the manual the tests follow."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from manual.pages import PAGES, blocks, inline, links, statements
from manual.unrun import ELSEWHERE, UNRUN, first


def main() -> None:
    """Print the counts, then what is not run and why."""
    typed = [one for page in PAGES for one in statements(page)]
    tables = {"run by another test": ELSEWHERE, "not run": UNRUN}
    left = {words: [one for one in typed if first(table, one.text)] for words, table in tables.items()}
    code = [one for page in PAGES for one in blocks(page) if one.language and not one.shell]
    every = [link for page in PAGES for link in links(page)]
    outside = [link for link in every if link.startswith(("http:", "https:"))]
    print(f"{len(PAGES)} pages")
    print(f"{len(every) - len(outside)} links lead to files and headings that exist; {len(outside)} lead outside")
    print(f"{len(typed) - sum(map(len, left.values()))} of {len(typed)} command lines are run")
    for words, table in tables.items():
        print(f"{len(left[words])} are {words}:")
        for pattern, reason in table.items():
            count = sum(first({pattern: reason}, one.text) is not None for one in left[words])
            print(f"  {count:3d}  {pattern:60s} {reason}")
    print(f"{sum(len(inline(page)) for page in PAGES)} commands inside sentences are parsed")
    languages = {one.language for one in code}
    counts = ", ".join(f"{sum(one.language == kind for one in code)} {kind}" for kind in sorted(languages))
    print(f"{len(code)} blocks of code are run or read: {counts}")


if __name__ == "__main__":
    main()
