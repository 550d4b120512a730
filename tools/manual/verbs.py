"""The page of the verbs: what `pneumo VERB --help` prints, word for word."""

import os

from pneumo_ros.command.main import VERBS, _verb, verb_parser

WIDTH = "100"  # of the help, in letters


def page() -> str:
    """Markdown: a section for each verb."""
    os.environ["COLUMNS"] = WIDTH
    return "\n\n".join(
        ["# Verbs", "Every verb of the command `pneumo`, as its `--help` says it.", *map(section, VERBS)]
    )


def section(verb: str) -> str:
    """One verb."""
    return f"(verb-{verb})=\n## pneumo {verb}\n\n```text\n{verb_parser(verb, _verb(verb)).format_help().rstrip()}\n```"
