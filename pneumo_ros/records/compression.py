"""Content of MCAP chunks, also of those that are cut or damaged: as much as can be decompressed."""

from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]  # the package ships no types
import zstandard

from pneumo_ros.errors import DataError

_PIECE = 1024  # bytes fed at a time when the whole does not decompress


def decompress(content: memoryview, compression: str, size: int, path: Path) -> bytes:
    """Decompressed `content`, of `size` bytes when it is whole; else the part before the damage.

    Raises DataError when the compression is neither none, zstd nor lz4.
    """
    if not compression:
        return bytes(content)
    if compression not in ("zstd", "lz4"):
        raise DataError(f"{path} is compressed with '{compression}'; zstd, lz4 and none can be read.")
    try:
        whole: bytes = zstandard.decompress(content, size) if compression == "zstd" else lz4.frame.decompress(content)
        return whole
    except (zstandard.ZstdError, RuntimeError, MemoryError):
        return _readable_part(content, compression)


def _readable_part(content: memoryview, compression: str) -> bytes:
    """Everything that decompresses before the break."""
    if compression == "zstd":
        stream = zstandard.ZstdDecompressor().decompressobj()
    else:
        stream = lz4.frame.LZ4FrameDecompressor()
    parts: list[bytes] = []
    try:
        for start in range(0, len(content), _PIECE):
            parts.append(stream.decompress(bytes(content[start : start + _PIECE])))
    except (zstandard.ZstdError, RuntimeError, EOFError):
        pass  # this is the damage: what came before it is what there is
    return b"".join(parts)
