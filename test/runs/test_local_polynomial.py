"""Local polynomials against scipy.signal, to the last digits: scipy sums in another order from version to version."""

import subprocess
import sys

import numpy as np
import pytest

from pneumo_ros.runs.local_polynomial import along, weights

CASES = [(25, 3, 0), (25, 3, 1), (37, 3, 2), (25, 2, 0), (5, 3, 2), (3, 2, 0), (3, 0, 0)]


@pytest.mark.parametrize(("width", "order", "derivative"), CASES)
@pytest.mark.parametrize("step", [1e-3, 0.05])
def test_they_are_those_of_scipy(width: int, order: int, derivative: int, step: float) -> None:
    from scipy.signal import savgol_coeffs, savgol_filter

    signal = np.random.default_rng(3).normal(size=160).cumsum()
    signal[80] = np.nan  # a message that was lost
    theirs = (
        savgol_coeffs(width, order, deriv=derivative, delta=step),
        savgol_filter(signal, width, order, deriv=derivative, delta=step),
    )
    ours = (weights(width, order, derivative, step), along(signal, width, order, derivative, step))
    for mine, scipys in zip(ours, theirs, strict=True):
        np.testing.assert_allclose(mine, scipys, rtol=0.0, atol=1e-12 * np.nanmax(np.abs(scipys)))


def test_verbs_start_without_what_is_slow_to_import() -> None:
    verbs = "import pneumo_ros.compare.compare, pneumo_ros.diagnose.diagnosis, pneumo_ros.identify.campaign"
    line = f"import sys, {verbs[7:]}; print([one for one in ('scipy.signal', 'scipy.stats') if one in sys.modules])"
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stderr
