"""One page for all tests of reports; every test opens it again."""

from collections.abc import Iterator
from typing import Any

import pytest
from report.browser import Visit
from report.pages import compared, report_of

from pneumo_ros.report.page import page_html


@pytest.fixture(scope="session")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Of a report of two runs, as a file."""
    path = tmp_path_factory.mktemp("report") / "report.html"
    path.write_text(page_html(report_of(*compared())), encoding="utf-8")
    return path.as_uri()


@pytest.fixture
def visit(browser: Any, address: str) -> Iterator[Visit]:
    """The page, opened in a wide window."""
    opened = Visit(browser, address)
    yield opened
    opened.close()
