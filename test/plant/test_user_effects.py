"""A user's file of effects: plain text gives a compiled kernel, edits take effect, and only two names are imported."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from plant.catalogue import in_python
from plant.user_files import AXIS, HEAD, composed, one, seen

from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Library, Stepper, load_model

SEAL_LEAK = '''
class SealLeak(Effect):
    """Turbulent leakage across the piston seal. Source, eq."""
    conductance = Parameter(2e-11, "kg/(s*sqrt(Pa))", "seal leak coefficient", low=0.0)
    threshold = Parameter(1.0, "Pa", "regularisation near zero pressure difference")

    def equations(p_a, p_b, conductance, threshold):
        leak = conductance * (p_a - p_b) / sqrt(abs(p_a - p_b) + threshold)
        flow_a, flow_b = -leak, leak
        return flow_a, flow_b
'''


def test_the_example_of_the_manual_works_as_it_stands(tmp_path: Path) -> None:
    """Nothing imported but Effect and Parameter; compiled, and equal to plain Python."""
    plain = composed(tmp_path, SEAL_LEAK, "seal_leak")
    x = plain.state(p_a=4e5, p_b=3e5)
    leak = 2e-11 * 1e5 / np.sqrt(1e5 + 1.0)
    change = plain.derivatives(x, 0.0)[0] - AXIS.derivatives(AXIS.state(p_a=4e5, p_b=3e5), 0.0)[0]
    assert change[2] == pytest.approx(-leak * 1.4 * 287.0 * 293.0 / 5.1e-4, rel=1e-9)
    assert change[3] == pytest.approx(leak * 1.4 * 287.0 * 293.0 / 4.0e-4, rel=1e-9)
    compiled = plain.with_parameters({"seal_leak.conductance": 1e-9})
    run = compiled.simulate(np.zeros(20), x)
    assert run.tobytes() == in_python(compiled).simulate(np.zeros(20), x).tobytes()


def test_constants_helpers_and_math_come_along(tmp_path: Path) -> None:
    body = "import math\nimport numpy as np\nfrom math import exp as e, floor\nK = 3.0\n\n"
    body += "def half(x: float) -> float:\n    'Half of it.'\n    part: float = 0.5\n    return part * x\n\n"
    body += one("v", "force = K * half(v) + e(v) + math.sqrt(v) + np.exp(v) + floor(v) + math.pi", "return force")
    own = seen(composed(tmp_path, body, "own"), "force", v=2.25) - 11.0
    assert own == pytest.approx(3.0 * 1.125 + 2.0 * np.exp(2.25) + 1.5 + 2.0 + np.pi, rel=1e-14)


def kernel_of(path: Path) -> Path:
    """File of the kernel that a model with effect `own` of this file runs."""
    model = load_model("axis", [path]).with_effects(["own"])
    assert model.kernel.__file__ is not None
    return Path(model.kernel.__file__)


def test_editing_a_helper_makes_another_kernel(tmp_path: Path) -> None:
    text = HEAD + "def stiffness(y):\n    return {value} * y\n" + one("y", "force = stiffness(y)", "return force")
    path = tmp_path / "own.py"
    path.write_text(text.format(value="10.0"))
    first = kernel_of(path)
    assert kernel_of(path) == first
    path.write_text(text.format(value="200.0"))
    second = kernel_of(path)
    assert second != first
    assert "return 200.0 * y" in second.read_text()


def test_plain_python_mode_runs_the_same_text() -> None:
    """NUMBA_DISABLE_JIT=1: same kernel file, same bits, and no numba is loaded."""
    program = (
        "import sys, numpy as np; from pneumo_ros.plant import load_model; m = load_model('axis');"
        "x = m.simulate(np.repeat([3.0, -3.0], 20), m.state(y=0.1, p_a=3e5, p_b=4e5));"
        "print(m.kernel.__file__, 'numba' in sys.modules, x.tobytes().hex())"
    )
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    file, numba, bits = done.stdout.split()
    assert file == AXIS.kernel.__file__
    assert numba == "False"
    compiled = AXIS.simulate(np.repeat([3.0, -3.0], 20), AXIS.state(y=0.1, p_a=3e5, p_b=4e5))
    assert bits == compiled.tobytes().hex()


def test_missing_effects_file_is_reported() -> None:
    with pytest.raises(UsageError, match=r"nowhere\.py does not exist"):
        Library(["nowhere.py"])


CLOCK = """
class Clock(Effect):
    \"\"\"Integrates the time, and counts steps: what a memory does that advances once per step.\"\"\"

    way = State("s", "integral of the time")
    count = State("1", "steps so far")
    last = State("s", "time at the end of the last step")

    def equations(t):
        der_way = t
        return der_way

    def advance(count, t):
        count = count + 1.0
        last = t
        return count, last
"""


def test_time_runs_on_and_memory_advances_once_per_step(tmp_path: Path) -> None:
    model = composed(tmp_path, CLOCK, "clock", base=())
    x = model.simulate(np.zeros(6), model.state(), sample_time=0.5, step=0.1, start=10.0)[:, 4:]
    t = 10.0 + 0.5 * np.arange(1, 7)
    assert x[:, 0] == pytest.approx(0.5 * (t**2 - 100.0), rel=1e-12)  # the midpoint rule is exact here
    assert x[:, 1].tolist() == [5.0, 10.0, 15.0, 20.0, 25.0, 30.0]
    assert x[:, 2] == pytest.approx(t, rel=1e-12)


def test_time_runs_on_in_parts_in_lanes_and_in_steppers(tmp_path: Path) -> None:
    model = composed(tmp_path, CLOCK, "clock", base=())
    whole = model.simulate(np.zeros(6), model.state(), sample_time=0.5, step=0.1, start=10.0)
    parted = model.simulate(np.zeros(6), model.state(), sample_time=1.0, step=0.1, start=10.0, parts=2)
    assert parted[:, 4:] == pytest.approx(whole[1::2, 4:], rel=1e-12)
    states, first = np.tile(model.state(), (2, 1)), [0, 2]
    lanes = model.simulate_lanes(np.zeros(6), states, first=first, samples=4, sample_time=0.5, step=0.1, start=10.0)
    assert lanes[0, :, 4:] == pytest.approx(whole[:4, 4:], rel=1e-12)
    assert lanes[1, -1, 4] == pytest.approx(0.5 * (13.0**2 - 11.0**2), rel=1e-12)
    one = model.simulate_lanes(np.zeros(6), states, samples=3, sample_time=1.0, step=0.1, start=10.0, parts=2)[0]
    assert one[:, 4:] == pytest.approx(parted[:, 4:], rel=1e-12)
    stepper = Stepper(model, model.state(), sample_time=0.5, step=0.1)
    assert [float(stepper.advance(0.0)[6]) for _ in range(3)] == pytest.approx([0.5, 1.0, 1.5], rel=1e-12)


FIRST_ORDER = """
class Lag(Effect):
    \"\"\"A first-order lag, far faster than the step, whose rate the integrator takes exactly.\"\"\"

    time_constant = Parameter(1e-6, "s", "time constant", low=1e-9, high=1.0)
    filtered = State("V", "filtered voltage")

    def equations(U, filtered, time_constant):
        rate_filtered = 1.0 / time_constant
        der_filtered = (U - filtered) / time_constant
        return der_filtered, rate_filtered
"""


@pytest.mark.parametrize("time_constant", [1e-9, 1e-6, 3e-4, 1e-2])
def test_a_state_with_a_rate_is_exact_at_any_speed(tmp_path: Path, time_constant: float) -> None:
    model = composed(tmp_path, FIRST_ORDER, "lag", base=())
    fast = in_python(model.with_parameters({"lag.time_constant": time_constant}))
    x = fast.simulate(np.full(10, 3.0), fast.state())[:, 4]
    assert x == pytest.approx(3.0 * -np.expm1(-1e-3 * np.arange(1, 11) / time_constant), rel=1e-11)
