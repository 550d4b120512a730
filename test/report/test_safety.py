"""A page from untrusted names in a real browser: it sends no requests and runs only its own script."""

from pathlib import Path

from report.browser import Visit
from report.pages import HOSTILE


def test_the_page_asks_for_nothing_but_itself(visit: Visit, address: str) -> None:
    names = visit.page.eval_on_selector_all(".plot", "all => all.map(one => one.id)")
    visit.page.evaluate("document.querySelectorAll('details').forEach(one => one.open = true)")
    visit.show(*names)
    # the first page's, two runs, three equations against seven variables, the friction map
    assert len(names) == 1 + 2 * 5 + 3 * 7 + 1
    assert visit.requests == [address]
    assert visit.complaints == []


def test_a_recording_cannot_run_a_script_by_its_name(visit: Visit) -> None:
    visit.show("run-2-position_m", "run-2-regimes", "friction-map")
    assert visit.page.evaluate("window.hacked") is None
    assert visit.page.locator("img").count() == 0
    assert visit.page.locator("#run-2 h3").inner_text() == HOSTILE


def test_markup_that_got_in_all_the_same_would_not_run(visit: Visit) -> None:
    insert = "document.body.insertAdjacentHTML('beforeend', '<img src=x onerror=\"window.hacked=3\">')"
    append = "document.body.append(Object.assign(document.createElement('script'), {text: 'window.hacked=4'}))"
    visit.page.evaluate(insert)
    visit.page.evaluate(append)
    visit.page.wait_for_timeout(200)
    assert visit.page.evaluate("window.hacked") is None
    assert sum("Content Security Policy" in complaint for complaint in visit.complaints) >= 2


def test_the_results_can_be_saved(visit: Visit) -> None:
    with visit.page.expect_download() as download:
        visit.page.get_by_role("button", name="Save the results").click()
    text = Path(download.value.path()).read_text(encoding="utf-8")
    assert '"schema_version": 1' in text
    assert '"provenance"' in text
