"""The axis to read from a recording: the namespace that its topics share."""

from pathlib import Path

from pneumo_ros.errors import DataError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records import contract

NEEDED = (
    f"{contract.JOINT_STATES}, {contract.PRESSURE_A}, {contract.PRESSURE_B} and {contract.COMMAND}, "
    f"one of both pressures to judge that chamber alone, "
    f"or {contract.JOINT_STATES} with effort alone for an axis driven by a force, with pressures to judge "
    f"friction and load alone, or with pressures or {contract.LOAD_CELL} for an imposed motion (--imposed)"
)


def choose_namespace(path: Path, types: dict[str, str], wanted: str | None) -> str:
    """Namespace, without slashes at its ends, of the axis to read; `types` are those of the recorded topics.

    Raises DataError when no axis was recorded, or several and `wanted` does not say which.
    """
    axes = _axes(types)
    if not axes:
        raise DataError(
            f"{path} holds no axis: {contract.JOINT_STATES} is missing. There is: {_listed(types)}. Needed: {NEEDED}."
        )
    if wanted is not None:
        plain = wanted.strip("/")
        below = [name for name in axes if name.endswith(f"/{plain}")]  # shoulder means /robot/shoulder
        if plain not in axes and len(below) != 1:
            raise DataError(f"{path}: {unknown_name('namespace', wanted, [_shown(name) for name in axes])}")
        return plain if plain in axes else below[0]
    # A robot's own joint states may lie beside those of the axis: the pressures show which namespace is the axis.
    likely = [name for name, parts in axes.items() if {contract.PRESSURE_A, contract.PRESSURE_B} <= parts] or list(axes)
    if len(likely) > 1:
        names = ", ".join(_shown(name) for name in sorted(likely))
        raise DataError(f"{path} holds {len(likely)} axes: {names}. Say which: --namespace {_shown(sorted(likely)[0])}")
    return likely[0]


def check_types(types: dict[str, str], namespace: str) -> None:
    """Raises DataError when a topic of the axis has another type than in the contract."""
    for topic, found in types.items():
        namespace_and_name = contract.split(topic)
        if namespace_and_name and namespace_and_name[0] == namespace:
            needed = contract.TYPES[namespace_and_name[1]]
            if found != needed:
                raise DataError(f"{topic} was recorded as {found}; it must be {needed}.")


def _axes(types: dict[str, str]) -> dict[str, set[str]]:
    """Contract names of the topics under each namespace that has joint states."""
    axes: dict[str, set[str]] = {}
    for topic in types:
        if found := contract.split(topic):
            axes.setdefault(found[0], set()).add(found[1])
    return {namespace: names for namespace, names in axes.items() if contract.JOINT_STATES in names}


def _shown(namespace: str) -> str:
    """A namespace as a user types it."""
    return f"/{namespace}"


def _listed(types: dict[str, str]) -> str:
    """Topics and types for a message."""
    return ", ".join(f"{topic} ({kind})" for topic, kind in sorted(types.items())) or "nothing"
