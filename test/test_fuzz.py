"""A short campaign of bad input over every parser; the long one is `make fuzz`."""

from pathlib import Path

import pytest
from fuzz import cutting, judging
from fuzz.parsers import PARSERS, Parser
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

RULES = settings(
    max_examples=60, deadline=None, database=None, derandomize=True, suppress_health_check=list(HealthCheck)
)


@pytest.mark.parametrize("parser", PARSERS, ids=lambda parser: parser.name)
def test_bad_input_is_answered_in_words(parser: Parser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)

    @RULES
    @given(parser.inputs())
    def one(data: bytes) -> None:
        verdict = judging.judge(parser, data, tmp_path)
        assert verdict.kind != judging.BROKEN, verdict.words

    one()


@pytest.mark.parametrize("parser", PARSERS, ids=lambda parser: parser.name)
def test_an_unspoilt_file_is_read(parser: Parser, tmp_path: Path) -> None:
    """Otherwise the campaign would pass with parsers that refuse everything."""
    verdict = judging.judge(parser, parser.sound(), tmp_path)
    assert (verdict.kind, verdict.words) == (judging.RESULT, "")


def test_the_judge_sees_tracebacks_slowness_and_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judging, "TIME", 0.2)

    def verdict(read: object) -> str:
        parser = Parser("none", "x", read, lambda: st.just(b""), lambda: b"")
        return judging.judge(parser, b"", tmp_path).kind

    def for_ever(path: Path) -> None:
        while path.exists():
            pass

    assert verdict(lambda path: None) == judging.RESULT
    assert verdict(lambda path: path.joinpath("none").read_text()) == judging.BROKEN
    assert verdict(for_ever) == judging.BROKEN
    assert verdict(lambda path: path.with_name(judging.CANARY).touch()) == judging.BROKEN


@given(st.integers(0, 2**32 - 1))
@example(0)
@settings(max_examples=3, deadline=None, database=None, derandomize=True)
def test_a_recording_cut_anywhere_is_read_up_to_the_cut(seed: int) -> None:
    name, data = cutting.recording()
    cuts = cutting.campaign(6, seed, (name, data[: 1 << 19]))
    assert not cuts.wrong, cuts.text()
    assert cuts.read > 0
