"""Grammars of text files: values that a YAML or JSON file may contain, and nearly valid documents."""

import json
from collections.abc import Mapping
from typing import Any

import yaml
from hypothesis import strategies as st

from fuzz.mutation import one_of

NUMBERS = st.one_of(
    st.floats(),
    st.integers(),
    st.integers(-10, 400).map(lambda digits: 10**digits),
    st.sampled_from([2**63, 2**64, -(2**63), -0.0, 1e308, 5e-324]),
)
SCALARS = st.one_of(st.none(), st.booleans(), NUMBERS, st.text(max_size=20), st.dates(), st.binary(max_size=8))
NAMES = st.one_of(st.text(max_size=12), NUMBERS, st.booleans(), st.none())
VALUES = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(NAMES, inner, max_size=4), max_leaves=12
)
BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join([f'*{a}'] * 9)}]\n" for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)  # nine references in each of nine lines: a few hundred bytes that expand to 9^9 words
STRANGE = [
    BOMB,
    BOMB + "/**: {ros__parameters: *i}\n",
    BOMB + "rosbag2_bagfile_information: *i\n",
    "/**: &a {ros__parameters: *a}\n",
    "&a [*a]\n",
    "? [a, b]\n: c\n",
    "? {a: b}\n: c\n",
    "[" * 100_000,
    "- " * 50_000,
    "{a: " * 20_000,
    "a: " + "9" * 100_000,
    "a: 0b" + "1" * 100_000,
    "a: 1:" + ":".join(["59"] * 20_000),
    "!!python/object/apply:os.system [touch canary]\n",
    "/**: !!python/object/new:os.system [touch canary]\n",
    "%YAML 9.9\n---\na\n",
    "---\na\n---\nb\n",
    "\ufeff/**: {}\n",
    "a: 2001-99-99\n",
    "a: !!int x\n",
    "a: !!float x\n",
    "a: !!timestamp 2001-13-45\n",
    "a: !!binary '='\n",
    "a: !!set [a]\n",
    "a: !!omap x\n",
    "a: !!pairs [x]\n",
    "<<: [a]\n",
    "=: a\n",
]


def nearly(document: Any) -> st.SearchStrategy[Any]:
    """`document` with some of its values, at any depth, replaced or left out, or with additional ones."""
    if isinstance(document, Mapping):
        kept = {key: st.one_of(nearly(value), nearly(value), VALUES) for key, value in document.items()}
        more = st.dictionaries(NAMES, VALUES, max_size=1)
        return st.builds(lambda some, odd: some | odd, st.fixed_dictionaries({}, optional=kept), more) | _whole(
            document
        )
    if isinstance(document, list) and document:
        return st.lists(st.one_of(*map(nearly, document), VALUES), max_size=len(document) + 1) | st.just(document)
    return st.one_of(st.just(document), st.just(document), VALUES)


def _whole(document: Mapping[Any, Any]) -> st.SearchStrategy[Any]:
    """All of the document, one of whose values may be strange."""
    return st.fixed_dictionaries({key: nearly(value) for key, value in document.items()})


def one_changed(document: Any) -> st.SearchStrategy[Any]:
    """All of `document` with a single value, at any depth, replaced."""
    if not isinstance(document, Mapping | list) or not document:
        return VALUES
    keys = list(document) if isinstance(document, Mapping) else list(range(len(document)))
    return st.sampled_from(keys).flatmap(
        lambda key: one_changed(document[key]).map(lambda new: _with(document, key, new))
    )


def _with(document: Any, key: Any, new: Any) -> Any:
    changed = dict(document) if isinstance(document, Mapping) else list(document)
    changed[key] = new
    return changed


def as_yaml(document: Any) -> bytes:
    """YAML in UTF-8, lone surrogates and all."""
    return yaml.safe_dump(document, allow_unicode=True).encode("utf-8", "surrogatepass")


def as_json(document: Any) -> bytes:
    """JSON; values without a JSON form become text."""
    return json.dumps(document, default=str, skipkeys=True).encode()


def yaml_files(document: Any) -> st.SearchStrategy[bytes]:
    """Files with nearly `document`, with anything, and with strange YAML."""
    strange = one_of([text.encode() for text in STRANGE])
    return st.one_of(one_changed(document).map(as_yaml), nearly(document).map(as_yaml), VALUES.map(as_yaml), strange)


def json_files(document: Any) -> st.SearchStrategy[bytes]:
    """The same for JSON."""
    deep = one_of([b"[" * 100_000, b'{"a":' * 50_000, b"9" * 10_000, b"NaN", b"1e999", b'"\\ud800"', b""])
    return st.one_of(nearly(document).map(as_json), VALUES.map(as_json), deep)


CELLS = st.one_of(
    NUMBERS.map(str), st.text(max_size=6), st.sampled_from(["", " ", "nan", "inf", "0.1", "1e999", "0x1"])
)
ROWS = st.lists(CELLS, max_size=4).flatmap(lambda cells: st.sampled_from(",;\t ").map(lambda mark: mark.join(cells)))
SERIES = st.lists(st.tuples(st.floats(-1e9, 1e13), NUMBERS), max_size=9).map(
    lambda rows: "\n".join(f"{time},{volts}" for time, volts in sorted(rows, key=lambda row: row[0])).encode()
)
CSV_FILES = SERIES | st.lists(ROWS, max_size=12).map(lambda rows: "\n".join(rows).encode("utf-8", "surrogatepass"))
