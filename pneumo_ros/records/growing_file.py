"""An MCAP file that is valid at any time, also after its writer was killed."""

import os
from contextlib import suppress
from pathlib import Path

from mcap.data_stream import RecordBuilder
from mcap.records import DataEnd, Footer

from pneumo_ros.records.mcap_file import MAGIC


def _end() -> bytes:
    """The records that end an MCAP file without a summary."""
    builder = RecordBuilder()
    DataEnd(0).write(builder)
    Footer(summary_start=0, summary_offset_start=0, summary_crc=0).write(builder)
    records: bytes = builder.end()  # type: ignore[no-untyped-call]  # mcap annotates only some of its methods
    return records + MAGIC


class GrowingFile:
    """Output stream of an `mcap.writer.Writer`: each flush replaces the old end by the new data and a new end.

    That is one system write, which a killed process has either done or not. Readers that require an end, such as
    rosbags, can read the file at any time.
    """

    END = _end()

    def __init__(self, path: Path) -> None:
        """Create the file. Raises OSError, also when it exists."""
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        self._new = bytearray()
        self._settled = 0  # bytes of the file that are final

    def write(self, data: bytes) -> int:
        """Keep `data` for the next flush."""
        self._new += data
        return len(data)

    def tell(self) -> int:
        """Position of the next byte."""
        return self._settled + len(self._new)

    def flush(self) -> None:
        """Write the new data to the file. Raises OSError when the disk is full; the file is then as it was before."""
        try:
            _write_at(self._descriptor, self._new + self.END, self._settled)
        except OSError:
            self._restore()
            raise
        self._settled += len(self._new)
        self._new.clear()

    def close(self) -> None:
        """Write the remaining data, which includes its own end, to the disk. Raises OSError as `flush` does."""
        try:
            _write_at(self._descriptor, self._new, self._settled)
            os.fsync(self._descriptor)
        except OSError:
            self._restore()
            raise
        finally:
            os.close(self._descriptor)

    def _restore(self) -> None:
        """Write the end again where it was: its disk space is already allocated."""
        with suppress(OSError):  # if this fails too, the first failure is reported
            _write_at(self._descriptor, bytearray(self.END), self._settled)
            os.ftruncate(self._descriptor, self._settled + len(self.END))


def _write_at(descriptor: int, data: bytearray, position: int) -> None:
    """Write all of `data`: the system may write less per call."""
    done = 0
    while done < len(data):
        done += os.pwrite(descriptor, data[done:], position + done)
