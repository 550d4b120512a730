"""A short campaign of faults in real processes; the long one is `make chaos`."""

from pathlib import Path
from random import Random

import pytest
from chaos.campaign import campaign, kinds, order

FAULTS = (
    "bytes that are no message",
    "clock jumps",
    "kill -9 of the recorder",
    "oversized messages",
    "read-only folder",
)


@pytest.mark.check
def test_faults_leave_everything_in_order(tmp_path: Path) -> None:
    faults = [name for name in FAULTS if name in kinds(tmp_path)[0]]
    outcome = campaign(tmp_path, len(faults), 5, 120.0, faults)
    assert not outcome.broken, outcome.text()
    assert sum(result.count for result in outcome.results) == len(faults)
    assert outcome.recorded > 100


@pytest.mark.check
@pytest.mark.parametrize("fault", ["disk full while recording", "disk full of uploads"])
def test_a_disk_that_fills_up_leaves_what_is_whole(fault: str, tmp_path: Path) -> None:
    faults, without = kinds(tmp_path)
    if without:
        pytest.skip("a small disk can be mounted by root only")
    outcome = campaign(tmp_path, 1, 5, 60.0, [name for name in faults if name == fault])
    assert not outcome.broken, outcome.text()


def test_every_kind_of_fault_has_its_turn() -> None:
    drawn = order("abcde", 12, Random(1))
    assert sorted(drawn[:5]) == sorted(drawn[5:10]) == list("abcde")
    assert order("abcde", 12, Random(1)) == drawn
    assert order("abcde", 12, Random(2)) != drawn
