"""Keeps numba's cache valid: numba checks only the file of the cached function, not the files it calls."""

from pathlib import Path

HERE = Path(__file__).parent


def drop_stale_kernels() -> None:
    """Delete the indices of compiled kernels that are older than any source of this package."""
    newest = max(source.stat().st_mtime for source in HERE.glob("*.py"))
    for index in (HERE / "__pycache__").glob("*.nbi"):
        if index.stat().st_mtime < newest:
            index.unlink(missing_ok=True)
