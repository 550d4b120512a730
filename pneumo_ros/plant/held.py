"""Held inputs as kernels take them: rows, one after another in time, of all inputs of a machine."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pneumo_ros.errors import UsageError

Array = NDArray[np.float64]


def held_inputs(given: ArrayLike, names: Sequence[str]) -> Array:
    """Inputs (rows, inputs) from (rows,) of the only input, or (rows, inputs) in the order of `names`.

    No copy where none is needed: fits call this often, with minutes of data. Raises UsageError for other shapes and
    for numbers that are not finite.
    """
    # a kernel would be compiled again for an array that is read-only or not contiguous
    held = np.require(np.atleast_1d(np.asarray(given, dtype=float)), float, ["C", "W"])
    held = held.reshape(-1, 1) if held.ndim == 1 and len(names) == 1 else held
    if held.ndim != 2 or held.shape[1] != len(names):
        raise UsageError(f"inputs of shape {np.shape(given)} do not fit: {_needed(names)}")
    if not np.isfinite(held).all():
        raise UsageError(f"inputs of shape {np.shape(given)} must be finite numbers: {_needed(names)}")
    return held


def _needed(names: Sequence[str]) -> str:
    if len(names) == 1:
        return "this machine takes one row of finite numbers, valve voltages [V] or driving forces [N]"
    return f"this machine takes a row of {len(names)} numbers for every sample: {', '.join(names)}"


def input_rows(given: ArrayLike | None, names: Sequence[str], rows: int) -> Array:
    """Inputs (rows or more, inputs) for `rows` rows, as `held_inputs`: None means zeros, a single row is repeated.

    Raises UsageError as `held_inputs`, and for too few rows.
    """
    held = held_inputs(np.zeros((1, len(names))) if given is None else given, names)
    if len(held) == 1:
        held = np.repeat(held, rows, axis=0)
    if len(held) < rows:  # the kernel would read beyond their end
        raise UsageError(f"{len(held)} rows of inputs do not cover {rows} samples")
    return held
