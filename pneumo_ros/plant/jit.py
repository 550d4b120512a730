"""How generated kernels are compiled: decorators and the three bit operations numba cannot express.

With NUMBA_DISABLE_JIT=1 the same module runs in pure Python, breakpoints and all.
"""

import contextlib
import importlib
import os
import sys
from collections.abc import Callable
from typing import Any

from pneumo_ros.errors import PneumoError
from pneumo_ros.plant import maths

PURE_PYTHON = os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")


def _as_it_is(function: Any) -> Any:
    return function


if PURE_PYTHON:
    inline: Any = _as_it_is
    block: Any = _as_it_is
    entry: Any = _as_it_is
    summed: Any = _as_it_is
    power_of_two, exponent, mantissa = maths.power_of_two, maths.exponent, maths.mantissa

    def get(cells: Any, first: int, i: int) -> Any:
        return cells[first + i]

    def put(cells: Any, first: int, i: int, value: float) -> None:
        cells[first + i] = value
else:
    try:
        import numba
        from llvmlite import binding, ir
        from numba.extending import intrinsic
    except ImportError as error:
        raise PneumoError(
            "numba is missing: it compiles the plant. Type: pip install numba (or: sudo apt install python3-numba). "
            "NUMBA_DISABLE_JIT=1 runs the plant in pure Python, some hundred times slower."
        ) from error

    # error_model: a division never branches to an exception, or no loop would vectorise. No fast-math: compiled and
    # interpreted results are equal to the bit. The wrappers would serve callers from Python and C; leaving them out
    # saves a third of the time to compile.
    njit: Any = numba.njit  # its stubs do not know all its options
    inline = njit(forceinline=True, error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True)
    block = njit(error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True)  # called, not copied
    entry = njit(cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True)
    # Terms of a sum in any order, or no sum would vectorise: for what is no part of the plant.
    summed = njit(cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True, fastmath={"reassoc"})

    # LLVM gives up merging the memory checks of a loop after 100 comparisons; with forty effects, loops over lanes
    # would stay scalar and take eight times as long. LLVM ends the process if an option is given twice.
    MERGED = "-memory-check-merge-threshold=1000"
    if MERGED not in vars(binding):
        binding.set_option("pneumo_ros", MERGED)
        vars(binding)[MERGED] = True

    def _load_without_scipy() -> None:
        """Load what numba loads at its first call, but for scipy.linalg: no kernel needs it, and it takes a quarter."""
        linalg: Any = importlib.import_module("numba.np.linalg")
        look_for_blas = linalg.ensure_blas
        linalg.ensure_blas = lambda: None
        try:
            arrays: Any = importlib.import_module("numba.np.arraymath")
        finally:
            linalg.ensure_blas = look_for_blas
        arrays.ensure_blas = look_for_blas

    if "numba.np.arraymath" not in sys.modules:
        with contextlib.suppress(ImportError, AttributeError):  # a numba that does it otherwise only starts later
            _load_without_scipy()

    _I64, _F64 = ir.IntType(64), ir.DoubleType()
    _EXPONENT_ONE, _MANTISSA_BITS = 0x3FF0000000000000, 0x000FFFFFFFFFFFFF

    def _real_function(build: Callable[[Any, Any], Any]) -> Any:
        signature = numba.float64(numba.float64)

        @intrinsic
        def function(context: Any, x: Any) -> Any:
            return signature, lambda _context, builder, _signature, arguments: build(builder, arguments[0])

        return function

    def _build_power_of_two(builder: Any, k: Any) -> Any:
        bits = builder.bitcast(builder.fadd(k, ir.Constant(_F64, maths._ROUND)), _I64)
        return builder.bitcast(builder.shl(builder.add(bits, ir.Constant(_I64, 1023)), ir.Constant(_I64, 52)), _F64)

    def _build_exponent(builder: Any, x: Any) -> Any:
        biased = builder.lshr(builder.bitcast(x, _I64), ir.Constant(_I64, 52))
        # integer to float by bits, 2**52 + biased, because AVX2 has no conversion from 64-bit integers
        as_float = builder.bitcast(builder.or_(biased, ir.Constant(_I64, 0x4330000000000000)), _F64)
        return builder.fsub(as_float, ir.Constant(_F64, 4503599627370496.0 + 1023.0))

    def _build_mantissa(builder: Any, x: Any) -> Any:
        bits = builder.and_(builder.bitcast(x, _I64), ir.Constant(_I64, _MANTISSA_BITS))
        return builder.bitcast(builder.or_(bits, ir.Constant(_I64, _EXPONENT_ONE)), _F64)

    # Entry i of a row that begins at `first` in a one-dimensional array: an index takes ten times as long to compile.
    @intrinsic
    def get(_context: Any, cells: Any, _first: Any, _i: Any) -> Any:
        def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.load(_entry(context, builder, signature, arguments))

        return numba.float64(cells, numba.int64, numba.int64), build

    @intrinsic
    def put(_context: Any, cells: Any, _first: Any, _i: Any, _value: Any) -> Any:
        def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            builder.store(arguments[3], _entry(context, builder, signature, arguments))
            return context.get_dummy_value()

        return numba.void(cells, numba.int64, numba.int64, numba.float64), build

    def _entry(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        cells = context.make_array(signature.args[0])(context, builder, arguments[0])
        return builder.gep(cells.data, [builder.add(arguments[1], arguments[2])])

    power_of_two = _real_function(_build_power_of_two)
    exponent = _real_function(_build_exponent)
    mantissa = _real_function(_build_mantissa)
