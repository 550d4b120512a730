"""A real browser, headless: Debian's Chromium driven by Playwright, or the reason why there is none."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome")
# The browser sends no requests of its own, so that every request is the page's
QUIET = (
    "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
)  # fmt: skip


def missing() -> str:
    """Why there is no browser to test with, and the command that changes it; empty when there is one."""
    if not any(shutil.which(name) for name in NAMES):
        return "no Chromium to look at reports with; type: sudo apt-get install chromium"
    try:
        import playwright  # noqa: F401 - asked for, not used
    except ImportError:
        return "no Playwright to drive the browser with; type: pip install playwright"
    return ""


@contextmanager
def chromium() -> Iterator[Any]:
    """A running browser; skips the test, saying why, when there is none."""
    if reason := missing():
        pytest.skip(reason)
    from playwright.sync_api import sync_playwright

    program = next(found for name in NAMES if (found := shutil.which(name)))
    arguments = [*QUIET, *(["--no-sandbox"] if os.geteuid() == 0 else [])]
    # A socket's path has 107 characters at most, and Chromium puts one below TMPDIR, which may lie deep in a checkout
    environment = {name: value for name, value in os.environ.items() if name != "TMPDIR"}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=arguments, env=environment, timeout=300_000)
        try:
            yield browser
        finally:
            browser.close()


class Visit:
    """An opened page without a network, with its requests and error messages."""

    def __init__(self, browser: Any, address: str, width: int = 1280, scheme: str = "light") -> None:
        context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme, offline=True)
        self.page = context.new_page()
        self.page.set_default_timeout(300_000)  # ms; a busy machine is no failure
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(address)

    def close(self) -> None:
        """Leave the page."""
        self.page.context.close()

    def wait(self, expression: str, argument: Any = None) -> None:
        """Wait until an expression is true; the page's policy forbids the script of Playwright's own waiting."""
        for _ in range(2400):
            if self.page.evaluate(expression, argument):
                return
            self.page.wait_for_timeout(50)
        pytest.fail(f"never true: {expression} of {argument}")

    def show(self, *charts: str) -> None:
        """Scroll to charts and wait until they are drawn."""
        for chart in charts:
            self.page.evaluate("id => document.getElementById(id).scrollIntoView({behavior: 'instant'})", chart)
            self.wait("id => document.getElementById(id).dataset.drawn === 'yes'", chart)

    def traces(self, chart: str) -> list[dict[str, Any]]:
        """The present content of a chart: name, visible, x and y of every trace."""
        pick = "t => ({name: t.name, visible: t.visible, x: [...t.x], y: [...t.y]})"
        found: list[dict[str, Any]] = self.page.evaluate(f"id => document.getElementById(id).data.map({pick})", chart)
        return found

    def range(self, chart: str) -> list[float]:
        """The range of the x axis of a chart."""
        return [float(v) for v in self.page.evaluate("id => document.getElementById(id).layout.xaxis.range", chart)]

    def wait_for_range(self, chart: str, low: float, high: float) -> None:
        """Wait until the x axis of a chart spans about this range."""
        near = "r => Math.abs(r[0] - low) + Math.abs(r[1] - high) < 0.05"
        span = "document.getElementById(id).layout.xaxis.range"
        self.wait(f"([id, low, high]) => ({near})({span})", [chart, low, high])

    def drag(self, chart: str, begin: float, end: float) -> None:
        """Drag across the upper panel of a chart, between two shares of its width."""
        box = self.page.locator(f"#{chart} .nsewdrag").first.bounding_box()
        height = box["y"] + 0.5 * box["height"]
        self.page.mouse.move(box["x"] + begin * box["width"], height)
        self.page.mouse.down()
        self.page.mouse.move(box["x"] + end * box["width"], height, steps=8)
        self.page.mouse.up()
