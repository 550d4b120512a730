"""A browser tab with the workbench: its content, its requests and its error messages."""

import time
from contextlib import suppress
from typing import Any
from urllib.parse import urlsplit

PATIENCE = 300_000  # ms; a busy machine is not a failure


class Tab:
    """A page that was opened; clicks are counted."""

    def __init__(self, browser: Any, address: str, width: int = 1280, scheme: str = "light") -> None:
        context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
        self.page = context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.clicks = 0
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("console", lambda message: self.complaints.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(address)
        self.page.locator("#effects input").first.wait_for()

    def close(self) -> None:
        """Leave the page."""
        self.page.context.close()

    def strangers(self, port: int) -> list[str]:
        """Requests that left the workbench."""
        inside = (f"127.0.0.1:{port}", "")  # without a host: data and blob addresses
        return [url for url in self.requests if urlsplit(url).netloc not in inside]

    def answer_late(self, words: str, seconds: float = 1.5) -> None:
        """From now on, answers to requests that contain these words arrive late, as on a busy machine."""
        self.page.evaluate(
            """([words, wait]) => { const real = window.fetch; window.fetch = async (url, how) => {
                 const answer = await real(url, how);
                 if (how && String(how.body).includes(words)) await new Promise((done) => setTimeout(done, wait));
                 return answer; }; }""",
            [words, 1e3 * seconds],
        )

    def press(self, name: str) -> None:
        """Click a button."""
        self.clicks += 1
        self.page.get_by_role("button", name=name, exact=True).click()

    def tick(self, effect: str) -> None:
        """Tick an effect; its list may be drawn again meanwhile."""
        self.clicks += 1
        self.page.get_by_label(effect, exact=True).click()
        self.wait_for_tick(effect, True)

    def wait_for_tick(self, effect: str, ticked: bool) -> None:
        """Wait until an effect is ticked, or not: the list follows the rest of the page."""
        from playwright.sync_api import expect  # where it is missing, no browser is there, and tests are skipped

        expect(self.page.get_by_label(effect, exact=True)).to_be_checked(checked=ticked, timeout=PATIENCE)

    def view(self, name: str) -> None:
        """Choose a tab of the page, in the bar or in the row of tabs."""
        self.clicks += 1
        step = self.page.locator("#lead [data-tab]").get_by_text(name, exact=True)
        (step if step.count() else self.page.locator("#tab").get_by_text(name, exact=True)).click()

    def see(self, selector: str, text: str = "") -> Any:
        """Wait until an element that contains `text` is visible."""
        found = self.page.locator(selector).filter(has_text=text).first
        found.wait_for(state="visible")
        return found

    def traces(self) -> list[dict[str, Any]]:
        """Name, x and y of the traces in the plot of the run."""
        pick = "one => (one._fullData || []).map(t => ({name: t.name, x: [...t.x], y: [...t.y], yaxis: t.yaxis}))"
        found: list[dict[str, Any]] = self.page.locator("#signals").evaluate(pick)
        return found

    def wait_for_traces(self, ready: Any, patience: float = 120.0) -> list[dict[str, Any]]:
        """Wait until the traces of the plot are `ready`, for `patience` [s]: a look at long traces takes a while."""
        found, end = [], time.monotonic() + patience
        while time.monotonic() < end:
            found = self.traces() if self.page.locator("#signals .main-svg").count() else []
            if ready(found):
                return found
            self.page.wait_for_timeout(50)
        raise AssertionError(f"the plot never was as expected; it shows {[one['name'] for one in found]}")

    def double_click_until(self, ready: Any) -> None:
        """Double-click the plot until its traces are `ready`: on a busy machine the two clicks may be too far apart."""
        for _ in range(12):
            self.page.locator("#signals .nsewdrag").first.dblclick()
            with suppress(AssertionError):
                self.wait_for_traces(ready, patience=5.0)
                return
        self.wait_for_traces(ready)

    def drag(self, begin: float, end: float) -> None:
        """Drag across the plot of the run, between two shares of its width."""
        box = self.page.locator("#signals .nsewdrag").first.bounding_box()
        height = box["y"] + 0.5 * box["height"]
        self.page.mouse.move(box["x"] + begin * box["width"], height)
        self.page.mouse.down()
        self.page.mouse.move(box["x"] + end * box["width"], height, steps=8)
        self.page.mouse.up()
