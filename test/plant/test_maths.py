"""The elementary functions against the C library's, to a few units in the last place; compiled against plain."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from pneumo_ros.plant import maths
from pneumo_ros.plant.kernels import load_kernel
from pneumo_ros.plant.source import SourceBook

RANDOM = np.random.default_rng(7)


def spread(low: float, high: float, n: int = 4000) -> np.ndarray:
    """Magnitudes spread evenly over the decades from low to high."""
    return np.exp(RANDOM.uniform(math.log(low), math.log(high), n))


def both_signs(low: float, high: float) -> np.ndarray:
    """`spread`, of either sign."""
    return spread(low, high) * RANDOM.choice([-1.0, 1.0], 4000)


def reference_relaxation(a: float) -> float:
    """(1 - exp(-a)) / a from the C library, which keeps its digits near 0."""
    return -math.expm1(-a) / a


# function, reference, arguments, largest error in units in the last place
CASES: list[tuple[Callable[[float], float], Callable[[float], float], np.ndarray, float]] = [
    (maths.exp, math.exp, both_signs(1e-300, 708.0), 1.0),
    (maths.exp, math.exp, RANDOM.uniform(-708.0, 709.0, 4000), 1.0),
    (maths.log, math.log, spread(2.3e-308, 1.7e308), 1.0),
    (maths.log, math.log, RANDOM.uniform(0.5, 2.0, 4000), 2.0),
    (maths.sqrt, math.sqrt, spread(1e-300, 1e300), 0.5),
    (maths.atan, math.atan, both_signs(1e-300, 1e300), 2.0),
    (maths.atan, math.atan, RANDOM.uniform(-4.0, 4.0, 4000), 2.0),
    (maths.relaxation, reference_relaxation, spread(1e-12, 1e-2), 4.0),
    (maths.relaxation, reference_relaxation, spread(1e-2, 700.0), 200.0),  # 1 - exp(-0.01) has lost two digits
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case[0].__name__)
def test_accurate_to_a_few_units_in_the_last_place(case) -> None:
    function, reference, arguments, ulps = case
    for x in arguments.tolist():
        exact = reference(x)
        assert abs(function(x) - exact) <= ulps * math.ulp(exact), f"{function.__name__}({x!r}), not {exact!r}"


# near a zero of the function, or after a reduction of the argument, only the absolute error can be small
ABSOLUTE = [
    (maths.sin, math.sin, RANDOM.uniform(-1e6, 1e6, 4000), 4e-16),
    (maths.sin, math.sin, both_signs(1e-9, 7.0), 3e-16),
    (maths.cos, math.cos, RANDOM.uniform(-1e6, 1e6, 4000), 4e-16),
    (maths.cos, math.cos, both_signs(1e-9, 7.0), 3e-16),
    (maths.tanh, math.tanh, both_signs(1e-9, 800.0), 5e-16),
]


@pytest.mark.parametrize("case", ABSOLUTE, ids=lambda case: case[0].__name__)
def test_accurate_in_absolute_terms(case) -> None:
    function, reference, arguments, error = case
    for x in arguments.tolist():
        assert abs(function(x) - reference(x)) <= error, f"{function.__name__}({x!r})"


def test_power_follows_the_c_library() -> None:
    for x, a in zip(spread(1e-30, 1e30).tolist(), RANDOM.uniform(-5.0, 5.0, 4000).tolist(), strict=True):
        assert maths.power(x, a) == pytest.approx(x**a, rel=4e-16 * (2.0 + abs(a * math.log(x))))
    assert maths.power(0.0, 0.5) < 1e-149


def test_signs_and_limits() -> None:
    assert [maths.sign(x) for x in (-2.0, 0.0, 1e-300)] == [-1.0, 0.0, 1.0]
    assert maths.exp(-1e9) == maths.exp(-708.0) < 4e-308
    assert math.isfinite(maths.exp(1e9))
    assert maths.relaxation(0.0) == maths.damped(0.0) == 1.0
    assert maths.tanh(-40.0) == -1.0


def test_damped_approximates_relaxation_to_second_order_and_never_overshoots() -> None:
    a = spread(1e-6, 1e6)
    error = np.array([maths.damped(x) - maths.relaxation(x) for x in a])
    assert np.all(np.abs(error) <= a**2 / 6.0 + 1e-15)
    assert np.all(np.array([x * maths.damped(x) for x in a]) < 1.0)


def test_compiled_and_interpreted_functions_agree_to_the_bit() -> None:
    """Functions inlined into a kernel, as the composer does it, over all arguments of the cases above."""
    book, rows = SourceBook(), [*CASES, *ABSOLUTE]
    functions = list(dict.fromkeys(case[0] for case in rows))
    names = [book.helper(function, "test") for function in functions]
    lines = "\n".join(f"        out[k, {i}] = {name}(x[k])" for i, name in enumerate(names))
    header = "from pneumo_ros.plant.jit import entry, exponent, inline, mantissa, power_of_two\nimport math\n\n"
    entry = f"@entry\ndef apply(x, out):\n    for k in range(len(x)):\n{lines}\n"
    kernel = load_kernel(header + "\n\n".join([*book.texts, entry]))
    for _, _, arguments, _ in rows:
        x = np.abs(arguments)
        compiled = np.empty((len(x), len(functions)))
        kernel.apply(x, compiled)
        interpreted = np.array([[function(value) for function in functions] for value in x.tolist()])
        assert compiled.tobytes() == interpreted.tobytes()
