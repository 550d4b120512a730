"""Topics of other programs, with other names and types, in the place of the contract's."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records import contract
from pneumo_ros.records.block import Integers
from pneumo_ros.records.topic_data import TopicData

# the number that stands for a message in the contract; commands have no stamp, so theirs is the recorded time
VALUES = {
    contract.JOINT_STATES: "position", contract.PRESSURE_A: "fluid_pressure", contract.PRESSURE_B: "fluid_pressure",
    contract.SUPPLY_PRESSURE: "fluid_pressure", contract.COMMAND: "data", contract.LOAD_CELL: "effort",
}  # fmt: skip
_PLACE = re.compile(r"(?P<topic>/?[\w/]+)(?::(?P<field>[\w.]+)(?:\[(?P<index>\d+)\])?)?")
_OF_JOINTS = ("position", "velocity", "effort")
_TEXTS = ("string", "wstring", "message")


def parse_place(text: str) -> tuple[str, str, int | None] | None:
    """Topic, field and index of a text such as /plc/values:data[3]; None for another text."""
    match = _PLACE.fullmatch(text.strip())
    if match is None:
        return None
    index = None if match["index"] is None else int(match["index"])
    return "/" + match["topic"].strip("/"), match["field"] or "", index


class ForeignTopic(TopicData):
    """A topic whose messages are of another type: one of their numbers stands for the contract's."""

    def __init__(self, data: TopicData, name: str, field: str, index: int | None) -> None:
        """`name` in the contract; `field` may be empty where the messages hold one number. DataError otherwise."""
        self.__dict__.update(data.__dict__)
        self._contract, self._index = name, index
        self._field = field or self._only_field()

    def __getitem__(self, field: str) -> NDArray[Any]:
        if field == VALUES[self._contract]:
            values = self._numbers()
            return values[:, np.newaxis] if field in _OF_JOINTS else values
        if field == "name":
            names = np.empty(len(self), dtype=object)
            names[:] = [()] * len(self)
            return names
        if field in _OF_JOINTS:
            return np.empty((len(self), 0))
        return super().__getitem__(field)

    @property
    def stamp(self) -> Integers:
        """Header stamps (n,) [ns]; the recorded times where the messages have none."""
        return super().stamp if "header.stamp.sec" in self._leaves else self.log_time

    def _numbers(self) -> NDArray[np.float64]:
        column = super().__getitem__(self._field)
        if self._index is not None and column.ndim == 2 and self._index < column.shape[1]:
            column = column[:, self._index]
        if column.ndim != 1 or column.dtype == object:
            size = f"{column.shape[1]} numbers" if column.ndim == 2 else "no numbers of one count"
            raise DataError(
                f"{self.name}: {self._field} of {self.type} holds {size}; say which, such as "
                f"{self.name}:{self._field}[0]"
            )
        return np.asarray(column, dtype=np.float64)

    def _only_field(self) -> str:
        numbers = [path for path, leaf in self._leaves.items() if leaf.base not in _TEXTS and path[:7] != "header."]
        if len(numbers) == 1:
            return numbers[0]
        raise DataError(
            f"{self.name} is of type {self.type}; say which of its fields is the {self._contract}, such as "
            f"{self.name}:{numbers[0] if numbers else 'data'} (there are {', '.join(numbers) or 'no numbers'})"
        )


def renamed(
    found: Mapping[str, TopicData], types: Mapping[str, str], topics: Mapping[str, str], where: str
) -> dict[str, TopicData]:
    """Topics by their names in the contract, as `topics` say; `types` of all that were recorded in `where`.

    Raises DataError, with the nearest names, for a topic that was not recorded or a field that it does not hold.
    """
    result: dict[str, TopicData] = {}
    for name, text in topics.items():
        place = parse_place(text)
        assert place is not None  # checked where it was read
        topic, field, index = place
        if topic not in found:
            raise DataError(f"{where}: {unknown_name('topic', topic, types)} (as {name})")
        same = found[topic].type == contract.TYPES[name] and not field
        result[name] = found[topic] if same else ForeignTopic(found[topic], name, field, index)
    return result
