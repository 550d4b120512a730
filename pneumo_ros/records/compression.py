"""Content of MCAP chunks, also of those that are cut or damaged: as much as can be decompressed."""

from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]  # the package ships no types
import zstandard

from pneumo_ros.errors import DataError, brief

_PIECE = 1024  # bytes fed at a time when the whole does not decompress
_ALWAYS, _RATIO = 1 << 26, 200  # largest content: bytes; times the compressed size
_LZ4 = 255  # highest compression ratio of lz4


def decompress(content: memoryview, compression: str, size: int, path: Path) -> bytes:
    """Decompressed `content`, of `size` bytes when it is whole; else the part before the damage.

    Content that is packed more tightly than any recording, and would fill the memory, is cut. Raises DataError when
    the compression is not none, zstd or lz4.
    """
    if not compression:
        return bytes(content)
    if compression not in ("zstd", "lz4"):
        raise DataError(f"{path} is compressed with {brief(compression)}; zstd, lz4 and none can be read.")
    most = max(_ALWAYS, _RATIO * len(content))
    try:
        if max(size, _announced(content, compression)) <= most:
            whole = zstandard.decompress(content, size) if compression == "zstd" else lz4.frame.decompress(content)
            return bytes(whole)
    except (zstandard.ZstdError, RuntimeError, MemoryError):
        pass
    return _readable_part(content, compression, most)


def _announced(content: memoryview, compression: str) -> int:
    """Decompressed size [bytes] that the content states; the largest possible one where it states none."""
    if compression == "zstd":
        return int(zstandard.frame_content_size(content))  # -1 when it states none: `size` decides then
    return int(lz4.frame.get_frame_info(content)["content_size"]) or _LZ4 * len(content)


def _readable_part(content: memoryview, compression: str, most: int) -> bytes:
    """Everything that decompresses before the break, or about `most` bytes."""
    if compression == "zstd":
        stream = zstandard.ZstdDecompressor().decompressobj()
    else:
        stream = lz4.frame.LZ4FrameDecompressor()
    parts: list[bytes] = []
    try:
        for start in range(0, len(content), _PIECE):
            parts.append(stream.decompress(bytes(content[start : start + _PIECE])))
            most -= len(parts[-1])
            if most < 0:
                break
    except (zstandard.ZstdError, RuntimeError, EOFError):
        pass  # the damage: the parts before it are returned
    return b"".join(parts)
