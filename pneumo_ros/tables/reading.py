"""The table in a file, read by the ending of its name, or by what it begins with."""

from collections.abc import Callable
from pathlib import Path

from pneumo_ros.errors import UsageError
from pneumo_ros.tables.formats.delimited import read_delimited
from pneumo_ros.tables.formats.matlab import read_matlab
from pneumo_ros.tables.formats.npz import read_npz
from pneumo_ros.tables.formats.objects import read_json, read_json_lines
from pneumo_ros.tables.formats.opening import content_of, ending
from pneumo_ros.tables.formats.parquet import read_parquet
from pneumo_ros.tables.table import Table

Reader = Callable[[Path, bytes], Table]

READERS: dict[str, Reader] = {
    ".csv": read_delimited, ".tsv": read_delimited, ".txt": read_delimited, ".dat": read_delimited,
    ".exp": read_delimited, ".asc": read_delimited, ".log": read_delimited,
    ".mat": read_matlab, ".npz": read_npz, ".npy": read_npz, ".parquet": read_parquet, ".pq": read_parquet,
    ".json": read_json, ".jsonl": read_json_lines, ".ndjson": read_json_lines,
}  # fmt: skip
# what a file begins with -> reader, whatever its name says
_SIGNS: dict[bytes, Reader] = {
    b"PAR1": read_parquet, b"MATLAB": read_matlab, b"\x93NUMPY": read_npz, b"PK\x03\x04": read_npz,
    b"\x89HDF": read_matlab,
}  # fmt: skip
_ELSEWHERE = {
    ".xlsx": "save the sheet as CSV", ".xls": "save the sheet as CSV", ".ods": "save the sheet as CSV",
    ".tdms": "export it as CSV", ".h5": "write its columns to CSV or NPZ", ".zip": "unpack it: unzip FILE",
    ".mcap": "it is a recording already", ".db3": "it is a recording already",
    ".bag": "convert it to rosbag2: rosbags-convert --src FILE --dst FOLDER", ".pkl": "write its columns to CSV or NPZ",
}  # fmt: skip


def read_table(path: str | Path) -> Table:
    """The table in the file at `path`, packed with gzip or not.

    Raises DataError when it cannot be read, UsageError for a folder and for a format that is not read.
    """
    file = Path(path)
    if file.is_dir():
        raise UsageError(f"{file} is a folder; name the tables in it: {file}/*")
    kind = ending(file)
    if kind in _ELSEWHERE:
        raise UsageError(
            f"{file}: {kind} is not read; {_ELSEWHERE[kind]}. Read are: {', '.join(READERS)}, each also .gz"
        )
    data = content_of(file)
    for sign, reader in _SIGNS.items():
        if data.startswith(sign):
            return reader(file, data)
    return READERS.get(kind, read_delimited)(file, data)
