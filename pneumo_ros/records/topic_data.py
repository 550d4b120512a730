"""Messages of one topic as columns."""

from collections.abc import Iterable
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.block import Channel, Integers
from pneumo_ros.records.layout import Layout, Leaf, leaves
from pneumo_ros.records.message_types import channel_types, deserialize

SET_BACK = 100_000_000  # ns: recorded times of a topic fall back by more only if the recorder's clock was set


class Part(NamedTuple):
    """Messages of one layout and their places among the messages of the topic, in the order of the file."""

    layout: Layout
    rows: NDArray[np.void]
    places: Integers


def set_back(log_time: Integers) -> Integers:
    """Indices of recorded times (n,) [ns], in the order of the file, that fall back by more than SET_BACK."""
    return np.flatnonzero(np.diff(log_time) < -SET_BACK) + 1


class TopicData:
    """Messages of one topic in the order of recorded time; `data["header.stamp.sec"]` is a column, made on request.

    Where the recorder's clock was set back, the order is that of the file. A column has shape (n,) for numbers and
    strings, (n, k) for arrays and for sequences that are equally long in all messages; else it holds one object per
    message. Strings are `str`, arrays of messages are lists.
    """

    def __init__(self, channel: Channel, log_time: Integers, parts: list[Part], odd: dict[int, bytes]) -> None:
        """`log_time` (n,) [ns] in the order of the file; `odd` are messages, by place, that no layout describes."""
        self.name, self.type = channel.topic, channel.type
        self._store = channel_types(channel)
        self._leaves = {leaf.path: leaf for leaf in leaves(self._store, channel.type)}
        self._parts, self._odd = parts, odd
        self._order = _order(log_time)
        self.log_time = log_time if self._order is None else log_time[self._order]

    def __len__(self) -> int:
        return len(self.log_time)

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(self._leaves)

    def __getitem__(self, field: str) -> NDArray[Any]:
        if field not in self._leaves:
            raise DataError(f"{self.name} ({self.type}): {unknown_name('field', field, self._leaves)}")
        leaf = self._leaves[field]
        pieces = [(part.places, _values(part, leaf)) for part in self._parts]
        pieces += [(np.array([place]), _single(value, leaf)) for place, value in self._odd_values(field)]
        column = _join(pieces, len(self), leaf)
        return column if self._order is None else column[self._order]

    @property
    def stamp(self) -> Integers:
        """Header stamps (n,) [ns]. Raises DataError when the messages have none."""
        stamp: Integers = self["header.stamp.sec"].astype(np.int64) * 1_000_000_000 + self["header.stamp.nanosec"]
        return stamp

    @cached_property
    def _odd_messages(self) -> dict[int, Any]:
        """Messages without a layout, deserialized one by one."""
        return {place: deserialize(self._store, payload, self.type) for place, payload in self._odd.items()}

    def _odd_values(self, field: str) -> Iterable[tuple[int, Any]]:
        for place, content in self._odd_messages.items():
            for name in field.split("."):
                content = getattr(content, name)
            yield place, content


def _values(part: Part, leaf: Leaf) -> NDArray[Any]:
    """Column of one part."""
    if leaf.base != "string":
        return part.rows[leaf.path].astype(leaf.dtype)
    column = np.empty(len(part.rows), dtype=object)
    column.fill(part.layout.texts[leaf.path])
    return column


def _single(value: Any, leaf: Leaf) -> NDArray[Any]:
    """Column of one message."""
    if leaf.base not in ("string", "message"):
        return np.asarray(value, dtype=leaf.dtype)[np.newaxis]
    column = np.empty(1, dtype=object)
    column[0] = tuple(value) if leaf.base == "string" and not isinstance(value, str) else value
    return column


def _join(pieces: list[tuple[Integers, NDArray[Any]]], count: int, leaf: Leaf) -> NDArray[Any]:
    """One column of `count` values from pieces, each with the places it goes to."""
    shapes = {values.shape[1:] for _, values in pieces}
    if len(pieces) == 1:  # a single piece is in order
        return pieces[0][1]
    if len(shapes) > 1:
        column = np.empty(count, dtype=object)
        for places, values in pieces:
            for place, value in zip(places.tolist(), values, strict=True):
                column[place] = value
        return column
    column = np.empty((count, *(shapes.pop() if shapes else leaf.shape)), dtype=leaf.dtype)
    for places, values in pieces:
        column[places] = values
    return column


def _order(log_time: Integers) -> Integers | None:
    """Indices in the order of time, None if in order: the files of a recording may overlap a little."""
    if np.all(log_time[1:] >= log_time[:-1]):
        return None
    bounds = [0, *set_back(log_time).tolist(), len(log_time)]
    return np.concatenate([a + np.argsort(log_time[a:b], kind="stable") for a, b in pairwise(bounds)])
