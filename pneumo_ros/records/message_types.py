"""Message definitions: those in a recording, and the standard ones for writing.

The definitions, their text form and the RIHS01 hash come from rosbags.
"""

import struct
from functools import lru_cache
from typing import Any

from rosbags.interfaces import Nodetype
from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

from pneumo_ros.errors import DataError, UsageError
from pneumo_ros.nearest import unknown_name
from pneumo_ros.records.block import Channel

ENCAPSULATION = 4  # bytes before a message that give its byte order
MOST_VALUES = 10_000  # of a message; nested definitions with more could fill the memory
_IDL_PART = "=" * 80 + "\nIDL: "


@lru_cache(maxsize=1)
def standard_types() -> Typestore:
    """Every message type of the newest ROS 2 distribution that rosbags knows."""
    return get_typestore(Stores.LATEST)


@lru_cache(maxsize=256)
def types_of(message_type: str, definition_format: str, definition: str) -> Typestore:
    """Types for reading a recording's messages of `message_type`: its own definition, else the standard one.

    Raises DataError when there is no definition or it cannot be understood.
    """
    if not definition:
        if message_type not in standard_types().fielddefs:
            raise DataError(f"The recording has no definition of {message_type}, which is no standard type either.")
        return standard_types()
    store = get_typestore(Stores.EMPTY)
    try:
        if definition_format == "ros2msg":
            store.register(get_types_from_msg(definition, message_type))
        elif definition_format in ("ros2idl", "omgidl"):
            for part in definition.split(_IDL_PART):
                if part.strip():
                    # Joined definitions carry the name of their type in front of each text.
                    store.register(get_types_from_idl(part.split("\n", 1)[1] if _IDL_PART in definition else part))
        else:
            raise DataError(f"{message_type} is defined in the format '{definition_format}'; ros2msg and ros2idl work.")
    except DataError:
        raise
    except Exception as error:  # rosbags runs code made from the definition, which can fail in any way
        reason = " ".join(str(error).split())[:200]
        raise DataError(f"The recording's definition of {message_type[:200]} cannot be understood: {reason}") from error
    _values(store, message_type, ())
    return store


def _values(store: Typestore, message_type: str, around: tuple[str, ...]) -> int:
    """Largest number of values in a message; a sequence counts once.

    Raises DataError beyond MOST_VALUES, or for a type that contains itself: it would never end.
    """
    if message_type in around:
        raise DataError(f"The recording's definition of {around[0]} holds {message_type} within itself.")
    total = 0
    definition: Any = store.fielddefs.get(message_type, ((), ()))[1]  # rosbags' own type of it is too general to check
    for _, (node, content) in definition:
        several = node in (Nodetype.ARRAY, Nodetype.SEQUENCE)
        inner, times = content if several else ((node, content), 1)
        if inner[0] == Nodetype.NAME:
            one = _values(store, inner[1], (*around, message_type))
        else:
            one = 1 if several and inner[1][0] in ("string", "wstring") else 0
        total += 1 + one * (times if node == Nodetype.ARRAY else 1)
        if total > MOST_VALUES:
            raise DataError(
                f"The recording's definition of {(*around, message_type)[0]} has too many fields to be read."
            )
    return total


def channel_types(channel: Channel) -> Typestore:
    """Types for reading the messages of `channel`. Raises DataError when they cannot be read."""
    if channel.encoding != "cdr":
        raise DataError(f"{channel.topic} is encoded as '{channel.encoding}'; only 'cdr', as ROS 2 writes it, is read.")
    return types_of(channel.type, channel.definition_format, channel.definition)


def definition_of(message_type: str, given: str = "") -> tuple[str, str]:
    """Text (ros2msg) and RIHS01 hash of a type, as in a recording; the hash is "" where rosbags has none.

    The text is that of the standard type, with its constants, unless `given` defines other fields. Raises UsageError
    for a type that is neither given nor standard.
    """
    store = standard_types()
    if given and not same_fields(types_of(message_type, "ros2msg", given), store, message_type):
        try:
            return given, types_of(message_type, "ros2msg", given).hash_rihs01(message_type)
        except KeyError:  # it has wide strings
            return given, ""
    if message_type not in store.fielddefs:
        raise UsageError(unknown_name("message type", message_type, store.fielddefs))
    text, _ = store.generate_msgdef(message_type, ros_version=2)
    return text, store.hash_rihs01(message_type)


def same_fields(given: Typestore, standard: Typestore, message_type: str) -> bool:
    """Whether both stores define the same fields for a type and all types within it."""
    inner = [name for name in given.fielddefs if name in standard.fielddefs]
    return message_type in inner and all(
        str(given.fielddefs[name][1]).replace("'char'", "'uint8'")  # Python's message classes do not distinguish them
        == str(standard.fielddefs[name][1]).replace("'char'", "'uint8'")
        for name in inner
    )


def message(message_type: str, **fields: Any) -> Any:
    """A message object of a standard type, for `serialize`."""
    return standard_types().types[message_type](**fields)


def serialize(content: Any) -> bytes:
    """CDR bytes of a message object made by `message`."""
    return bytes(standard_types().serialize_cdr(content, content.__msgtype__, little_endian=True))


def deserialize(store: Typestore, payload: bytes, message_type: str) -> Any:
    """Message object of CDR bytes. Raises DataError when they do not fit the type."""
    return _decoded(store, payload, message_type)[0]


def trimmed(payload: bytes, message_type: str) -> bytes:
    """A standard type's message without the extra bytes that ROS's own serialisation may leave at its end."""
    return payload[: _decoded(standard_types(), payload, message_type)[1]]


def _decoded(store: Typestore, payload: bytes, message_type: str) -> tuple[Any, int]:
    """Message object, and the number of bytes it takes."""
    if len(payload) < ENCAPSULATION or payload[:2] not in (b"\0\0", b"\0\1"):
        raise DataError(f"A message of type {message_type} is not plain CDR.")
    try:
        kind = store.get_msgdef(message_type)
        # Not `store.deserialize_cdr`, which refuses the extra bytes.
        decode = kind.deserialize_cdr_le if payload[1] else kind.deserialize_cdr_be
        message, size = decode(memoryview(payload)[ENCAPSULATION:], 0, kind.cls, store)
    except (SerdeError, KeyError, ValueError, struct.error) as error:
        raise DataError(f"A message does not fit its type {message_type}: {error}") from error
    return message, ENCAPSULATION + size
