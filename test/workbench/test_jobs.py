"""Jobs in a browser: found again after a reload, cancelled, separate from other tabs, errors reported."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from workbench.conftest import Served
from workbench.tab import Tab

Open = Callable[[], Tab]


def verbs_of(served: Served) -> list[str]:
    """Verbs that the workbench runs right now."""
    found = subprocess.run(["ps", "--ppid", str(served.process.pid), "-o", "args="], capture_output=True, text=True)
    return [line.split("pneumo_ros ", 1)[1].split()[0] for line in found.stdout.splitlines() if "pneumo_ros " in line]


def begun(tab: Tab, served: Served) -> None:
    """A long job runs."""
    tab.press("Diagnose")
    tab.see("#job-says", "Diagnosing")
    for _ in range(1200):
        if "diagnose" in verbs_of(served):
            return
        tab.page.wait_for_timeout(100)
    raise AssertionError("no verb was started")


def ended(tab: Tab, served: Served) -> None:
    """Cancel ends it, and leaves nothing behind."""
    tab.press("Cancel")
    tab.see("#job-says", "Cancelled; nothing was changed.")
    for _ in range(100):
        if not verbs_of(served):
            return
        tab.page.wait_for_timeout(100)
    raise AssertionError(f"still there: {verbs_of(served)}")


def test_a_reload_finds_the_job_again_and_cancel_ends_it(tab: Tab, served: Served) -> None:
    tab.tick("payload mass")
    begun(tab, served)
    tab.page.locator("#refit[disabled]").wait_for()
    tab.page.reload()
    tab.see("#job-says", "Diagnosing")
    assert tab.page.get_by_label("payload mass", exact=True).is_checked()
    ended(tab, served)
    tab.page.locator("#refit:not([disabled])").wait_for()
    tab.see("#machine", "axis (as given)")


@pytest.mark.check
def test_two_tabs_do_not_disturb_each_other(tab: Tab, another: Open, served: Served) -> None:
    other = another()
    begun(tab, served)
    other.see("#bags", "train_steps")
    assert not other.page.locator("#job").is_visible()
    other.press("Compare")
    other.see("#failures-content table.heat", "train_steps")
    assert tab.page.locator("#failures-content table.heat").count() == 0
    tab.see("#job-says", "Diagnosing")
    ended(tab, served)


@pytest.mark.check
def test_what_a_verb_refuses_is_reported(tab: Tab) -> None:
    for name in ("train_steps", "holdout_steps"):
        tab.page.get_by_role("group", name=f"What {name} is for").get_by_label("leave out").check()
    tab.see("#bags", "holdout_steps")
    tab.press("Compare")
    tab.see("#message", "there is no recording to compare with")
    tab.page.get_by_role("group", name="What train_steps is for").get_by_label("hold out").check()
    tab.press("Refit")
    tab.see("#message", "no recording is marked 'fit'")
    tab.press("Diagnose")
    tab.see("#message", "mark one 'fit'")


@pytest.mark.check
def test_a_bad_file_says_what_is_wrong_and_a_good_one_is_read(tab: Tab, leaking: Path, tmp_path: Path) -> None:
    (tmp_path / "broken.mcap").write_bytes(b"\x89MCAP0\r\n but nothing else")
    choose(tab, "files", [tmp_path / "broken.mcap"])
    tab.see("#bags .problem", "broken.mcap")
    (tmp_path / "notes.pdf").write_text("no recording")
    choose(tab, "files", [tmp_path / "notes.pdf"])
    tab.see("#upload-says", "notes.pdf is no part of a recording")
    assert len(tab.complaints) == 1  # the browser reports the refusal
    assert "400" in tab.complaints.pop()
    choose(tab, "a folder", leaking / "train_steps")
    tab.see("#bags", "train_steps (uploads/train_steps)")
    tab.page.get_by_role("button", name="train_steps (uploads/train_steps)").click()
    tab.wait_for_traces(lambda found: len(found) and len(found[0]["x"]) > 1000)


def choose(tab: Tab, what: str, files: object) -> None:
    """Choose files or a folder on the page."""
    with tab.page.expect_file_chooser() as chooser:
        tab.press(f"Choose {what}")
    chooser.value.set_files(files)
