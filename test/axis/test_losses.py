"""Counting lost messages by the sequence numbers of their publishers."""

import numpy as np
import pytest

from pneumo_ros.axis.losses import LossCount


def lost(*arrivals: tuple[str, int | None]) -> int:
    """Losses after (publisher, number) arrivals."""
    count = LossCount()
    for publisher, number in arrivals:
        count.note(publisher, number)
    return count.lost


def test_nothing_is_lost_before_the_first_message() -> None:
    assert lost(("a", 100), ("a", 101)) == 0


def test_gaps_are_counted_for_each_publisher() -> None:
    assert lost(("a", 1), ("b", 1), ("a", 4), ("b", 2), ("b", 4)) == 3


def test_a_middleware_without_numbers_counts_no_losses() -> None:
    assert lost(("a", None), ("a", None)) == 0


def test_a_message_that_comes_twice_is_no_loss() -> None:
    assert lost(("a", 1), ("a", 1), ("a", 2)) == 0


@pytest.mark.parametrize("seed", range(5))
def test_messages_that_overtake_each_other_are_not_lost(seed: int) -> None:
    rng = np.random.default_rng(seed)
    numbers = np.arange(1, 200)
    kept = numbers[np.concatenate([[True], rng.random(197) > 0.1, [True]])]
    order = np.argsort(kept[1:-1] + rng.uniform(0, 5, len(kept) - 2))
    arrivals = [1, *kept[1:-1][order].tolist(), 199]
    assert lost(*(("a", number) for number in arrivals)) == len(numbers) - len(kept)


def test_what_a_publisher_sent_first_counts_where_it_began_later() -> None:
    count = LossCount()
    count.note("a", 3, began_later=True)
    assert count.lost == 2
    count.note("a", 4, began_later=True)
    assert count.lost == 2
    count.note("b", 1, began_later=True)
    assert count.lost == 2
