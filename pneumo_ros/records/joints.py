"""The joint of `joint_states` that is the piston."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pneumo_ros.errors import DataError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.block import Integers
from pneumo_ros.records.contract import JOINT
from pneumo_ros.records.recording import Array
from pneumo_ros.records.series import Series
from pneumo_ros.records.topic_data import TopicData

FIELDS = ("position", "velocity", "effort")


def joint_series(data: TopicData, joint_name: str | None) -> tuple[str, Series]:
    """Name of the joint, and its position, velocity and effort: NaN where a message lacks one.

    Without `joint_name` it is the only joint, or the one called "piston". Raises DataError when there is no such joint.
    """
    names = data["name"].tolist()
    kinds = set(names)
    joint = _choose(data.name, sorted({name for kind in kinds for name in kind}), joint_name)
    # A publisher may leave out the name of a single joint; a message of other joints has no value of this one.
    places = {kind: kind.index(joint) if joint in kind else -1 if kind else 0 for kind in kinds}
    if len(kinds) == 1:
        place = np.full(len(names), places[names[0]])
    else:
        place = np.array([places[kind] for kind in names], dtype=np.int64)
    present = place >= 0
    values = {field: _column(data[field], place)[present] for field in FIELDS}
    return joint, Series(data.name, data.stamp[present], data.log_time[present], values)


def _choose(topic: str, joints: list[str], wanted: str | None) -> str:
    """The joint to take."""
    if wanted is not None and (wanted in joints or not joints):
        return wanted
    if wanted is not None:
        raise DataError(f"{topic}: {unknown_name('joint', wanted, joints)}")
    if not joints or JOINT in joints:
        return JOINT
    if len(joints) > 1:
        raise DataError(
            f"{topic} has several joints ({', '.join(joints)}); say which is the piston: --joint {joints[0]}"
        )
    return joints[0]


def _column(values: NDArray[Any], place: Integers) -> Array:
    """Entry `place` of each message's values, NaN where there is none."""
    if values.ndim == 2 and len(place) and (place == place[0]).all():
        if 0 <= place[0] < values.shape[1]:
            return np.ascontiguousarray(values[:, place[0]])
        return np.full(len(place), np.nan)
    rows = zip(values, place.tolist(), strict=True)
    return np.array([row[at] if 0 <= at < len(row) else np.nan for row, at in rows], dtype=float)
