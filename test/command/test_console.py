"""Which text goes to stdout and which to stderr."""

import io
import json
from pathlib import Path

import numpy as np
import pytest

from pneumo_ros.command.console import Console, Progress, columns, plain, program


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_results_and_messages_go_different_ways(capsys: pytest.CaptureFixture[str]) -> None:
    console = Console()
    console.say("result")
    console.note("message")
    assert capsys.readouterr() == ("result\n", "message\n")


def test_quiet_keeps_results(capsys: pytest.CaptureFixture[str]) -> None:
    console = Console(quiet=True)
    console.say("result")
    console.note("message")
    with console.progress("work") as progress:
        progress(0.5)
    assert capsys.readouterr() == ("result\n", "")


def test_json_on_stdout_is_alone_there(capsys: pytest.CaptureFixture[str]) -> None:
    console = Console(json_target="-")
    console.say("for a person")
    console.json({"rms": np.float64(2.5), "worst": float("nan"), "shape": np.arange(2), "file": Path("a")})
    assert json.loads(capsys.readouterr().out) == {"rms": 2.5, "worst": None, "shape": [0, 1], "file": "a"}


def test_json_file_appears_beside_the_text(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    console = Console(json_target=str(tmp_path / "result.json"))
    console.say("for a person")
    console.json({"value": 1})
    assert capsys.readouterr().out == "for a person\n"
    assert json.loads((tmp_path / "result.json").read_text()) == {"value": 1}
    assert [path.name for path in tmp_path.iterdir()] == ["result.json"]


def test_plain_keeps_whole_numbers_and_truth() -> None:
    assert plain({"n": np.int64(3), "ok": np.bool_(True), "inner": [(np.inf, None)]}) == {
        "n": 3,
        "ok": True,
        "inner": [[None, None]],
    }


def test_progress_without_a_terminal_is_one_line_per_ten_percent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Progress, "WAIT", 0.0)
    stream = io.StringIO()
    with Progress("Comparing", stream) as progress:
        for step in range(1001):
            progress(step / 1000)
    assert stream.getvalue().splitlines() == [f"Comparing: {percent} %" for percent in range(10, 101, 10)]


def test_progress_on_a_terminal_leaves_no_trace(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Progress, "WAIT", 0.0)
    stream = Terminal()
    with Progress("Comparing", stream) as progress:
        progress(0.5)
    assert "Comparing [############             ]  50 %" in stream.getvalue()
    assert stream.getvalue().endswith("\r\x1b[K")
    assert "\n" not in stream.getvalue()


def test_short_work_shows_no_progress() -> None:
    stream = io.StringIO()
    with Progress("Reading", stream) as progress:
        progress(1.0)
    assert stream.getvalue() == ""


def test_columns_align() -> None:
    assert columns([("a", "1"), ("bcd", "10")], right=[1]) == "a     1\nbcd  10"


@pytest.mark.parametrize(
    ("called", "found", "shown"),
    [
        (".venv/bin/pneumo", None, ".venv/bin/pneumo"),
        (".venv/bin/pneumo", ".venv/bin/pneumo", "pneumo"),
        ("site/pneumo_ros/__main__.py", None, "python -m pneumo_ros"),
    ],
)
def test_advice_names_the_command_as_it_can_be_typed(
    called: str, found: str | None, shown: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.argv", [called])
    monkeypatch.setattr("shutil.which", lambda name: found)
    assert program() == shown


def times_left(at: list[tuple[float, float]], monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What is said of the time left, for pairs of seconds passed and share done."""
    stream, now = io.StringIO(), [0.0]
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    with Progress("Diagnosing", stream) as progress:
        for k, (now[0], share) in enumerate(at):
            progress(share, f"step {k}")
    return [line.partition(" %")[2].partition(":")[0].removeprefix(", ") for line in stream.getvalue().splitlines()]


def test_the_time_left_does_not_rise(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search that slows down, as one did that said 3, 20, 46 and 10 minutes and was done after 21."""
    slowing = [(10.0, 0.05), (60.0, 0.3), (120.0, 0.45), (180.0, 0.5), (900.0, 0.6), (1200.0, 0.95), (1259.0, 0.99)]
    said = times_left(slowing, monkeypatch)
    assert said[0] == ""  # too early
    assert said[1:3] == ["about 2 min left", "about 80 s left"]
    assert said[3:5] == ["longer than estimated"] * 2
    shown = [float(one.split()[1]) * (60.0 if "min" in one else 1.0) for one in said if one.startswith("about")]
    assert shown == sorted(shown, reverse=True)


def test_the_time_left_follows_steady_work(monkeypatch: pytest.MonkeyPatch) -> None:
    said = times_left([(10.0 * k, 0.1 * k) for k in range(1, 10)], monkeypatch)
    assert said == [f"about {100 - 10 * k} s left" for k in range(1, 10)]
