"""The origin of a report: files with their hashes, machine file, versions, command line."""

from typing import Any

from pneumo_ros.report.chart import Section
from pneumo_ros.report.markup import Content, Html, table, tag


def origin_section(origin: dict[str, Any]) -> Section:
    """Everything needed to repeat the report and to check that it is about these files."""
    rows: list[tuple[Content, ...]] = [
        (one["file"], one["role"], f"{one['bytes']:,}".replace(",", " "), tag("code", one["sha256"]))
        for one in origin["files"]
    ]
    versions: list[tuple[Content, ...]] = [(name, version) for name, version in origin["versions"].items()]
    body = (
        tag("p", "Made by ", tag("code", origin["command"]), f" on {origin['created']}."),
        table(("file", "what", "bytes", "SHA-256"), rows, "Files", numeric=(2,)),
        table(("software", "version"), versions, "Versions"),
        tag("p", tag("button", "Save the results as JSON", type="button", id="save")),
    )
    return Section("origin", "Origin", Html("".join(body)))
