"""Composition: data flow decides the order, the kind of signal how contributions combine; every error has a message."""

from pathlib import Path

import pytest
from plant.catalogue import in_python
from plant.user_files import AXIS, composed, one, seen

from pneumo_ros.errors import UsageError


def test_effects_that_read_run_after_those_that_write(tmp_path: Path) -> None:
    """Listed first, the effect still sees the final opening and all flows."""
    body = one("opening, port_flow_a", "force = 10.0 * opening + port_flow_a", "return force")
    model = composed(tmp_path, body, base=("own", *AXIS.effects))
    assert seen(model, "force") == pytest.approx(11.0 + 22.2 + seen(AXIS, "port_flow_a"), rel=1e-12)


def test_sums_add_up(tmp_path: Path) -> None:
    body = one("v", "force = 5.0 + 0.0 * v", "return force") + one("v", "force = 7.0 * v", "return force", name="Other")
    assert seen(composed(tmp_path, body, "own", "other"), "force", v=2.0) == 11.0 + 5.0 + 14.0


def test_products_multiply(tmp_path: Path) -> None:
    text = [
        one("v", f"friction_scale = {k}", "return friction_scale", name=n) for n, k in (("Own", 0.5), ("Other", 3.0))
    ]
    model = composed(tmp_path, "".join(text), "own", "other")
    bound = 0.5 * 3.0 * 100.0 / 1.4e6  # to which the bristle is reset after a step
    for scaled, largest in ((model, bound), (in_python(AXIS), bound / 1.5)):
        x = scaled.simulate([0.0], scaled.state(v=0.1, z=2e-4), sample_time=1e-5, step=1e-5)
        assert x[0, 4] == pytest.approx(largest, rel=1e-12)


def test_singles_are_rewritten_in_the_order_listed(tmp_path: Path) -> None:
    body = one("spool", "spool = 2.0 * spool", "return spool") + one(
        "spool", "spool = spool + 1.0", "return spool", name="Other"
    )
    assert seen(composed(tmp_path, body, "own", "other"), "opening", 1.0) == pytest.approx(2.0 * 1.0 + 1.0 - 0.78)
    assert seen(composed(tmp_path, body, "other", "own"), "opening", 1.0) == pytest.approx(2.0 * (1.0 + 1.0) - 0.78)


def test_effects_that_rewrite_the_same_two_signals_meet_in_both(tmp_path: Path) -> None:
    both = "p_a_measured, p_b_measured"
    body = one(both, "p_a_measured = 2.0 * p_a_measured", "p_b_measured = 3.0 * p_b_measured", f"return {both}")
    lines = ("p_a_measured = p_a_measured + 1.0", "p_b_measured = p_b_measured + 4.0")
    model = composed(tmp_path, body + one(both, *lines, f"return {both}", name="Other"), "own", "other")
    assert seen(model, "p_a_measured", p_a=2e5) == 2.0 * 2e5 + 1.0
    assert seen(model, "p_b_measured", p_b=3e5) == 3.0 * 3e5 + 4.0


def test_an_effect_that_rewrites_one_signal_and_adds_to_another_runs_once(tmp_path: Path) -> None:
    """Its force is computed first, and depends on its own result."""
    body = one("stribeck", "stribeck = 0.5 * stribeck", "force = 8.0 * stribeck", "return stribeck, force")
    model = composed(tmp_path, body, "own")
    assert seen(model, "force") == pytest.approx(11.0 + 4.0)
    assert model.composition.text.count("own__equations(") == 4  # definition, derivatives, observation, of a block


def test_defaults_replace_missing_effects() -> None:
    model = in_python(AXIS.with_effects(["arctan_flow"]))
    assert seen(model, "opening", 3.0) == 3.0
    assert seen(model, "friction", v=1.0) == 0.0


def test_two_sources_of_a_single_signal_are_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"dead_zone and own both set opening; leave one of them out"):
        composed(tmp_path, one("voltage", "opening = voltage", "return opening"), "own")


def test_signals_that_wait_for_each_other_are_named(tmp_path: Path) -> None:
    body = one("friction", "friction_scale = 1.0 + 0.0 * friction", "return friction_scale")
    with pytest.raises(UsageError, match=r"depend on each other: .*friction_scale.*friction"):
        composed(tmp_path, body, "own")


STATE = '    {name} = State("m", "a state of its own")\n'
MISFITS = {
    "unknown argument": (one("velocity", "force = velocity", "return force"), r"unknown argument 'velocity'"),
    "misspelt argument": (one("frictoin", "force = frictoin", "return force"), r"did you mean friction"),
    "unknown result": (one("v", "forse = v", "return forse"), r"returns 'forse'.*did you mean force"),
    "input as result": (one("v", "U = v", "return U"), r"U, which is an input"),
    "ambiguous parameter": (
        one("v, mass", "force = v * mass", "return force")
        + one(
            "v", "force = v", "return force", name="Other", more='    mass = Parameter(1.0, "kg", "a second mass")\n'
        ),
        r"ambiguous; write one of piston__mass, other__mass",
    ),
    "state taken": (one("v", "der_z = v", "return der_z", more=STATE.format(name="z")), r"z of effect own is already"),
    "state like a name of the kernel": (
        one("v", "der_step = v", "return der_step", more=STATE.format(name="step")),
        r"step of effect own is already taken by the kernel",
    ),
    "state like a name of the step": (
        one("v", "der_y_m = v", "return der_y_m", more=STATE.format(name="y_m")),
        r"y_m of effect own is too similar to",
    ),
    "parameter like a state": (
        one("y", "force = y", "return force", more='    y = Parameter(1.0, "m", "a length")\n'),
        r"parameter y of effect own is the name of a state",
    ),
    "state without derivative": (
        one("v", "force = v", "return force", more=STATE.format(name="w")),
        r"declares state w but returns no der_w",
    ),
    "derivative without state": (one("v", "der_w = v", "return der_w"), r"returns der_w but declares no state w"),
    "early return": (
        one("v", "if v > 0.0:", "    return v", "force = v", "return force"),
        r"must end with its only return",
    ),
    "returned expression": (one("v", "return 2.0 * v"), r"plain, different names: assign first"),
    "no return": (one("v", "force = v"), r"must end with its only return"),
    "default argument": (one("v=1.0", "force = v", "return force"), r"plain arguments only"),
    "unknown function": (one("v", "force = expp(v)", "return force"), r"unknown name 'expp'; did you mean exp"),
    "builtin that does not compile": (one("v", "force = hash(v)", "return force"), r"This builtin does not compile"),
    "helper that calls itself": (
        "def again(x):\n    return again(x)\n" + one("v", "force = again(v)", "return force"),
        r"calls again, which calls itself",
    ),
    "no docstring": (
        "class Own(Effect):\n    def equations(v):\n        force = v\n        return force\n",
        r"docstring",
    ),
    "no effect": ("", r"defines no subclass"),
    "no Python": ("class:", r"does not run: SyntaxError"),
    "name taken": (one("v", "force = v", "return force", name="EndStop"), r"end_stop, which is already taken"),
}


@pytest.mark.parametrize("misfit", MISFITS)
def test_misfits_are_reported(tmp_path: Path, misfit: str) -> None:
    body, sentence = MISFITS[misfit]
    names = [name for name in ("own", "other") if f"class {name.capitalize()}(" in body]
    with pytest.raises(UsageError, match=sentence):
        composed(tmp_path, body, *names)


def test_an_ambiguous_parameter_may_be_written_in_full(tmp_path: Path) -> None:
    body = one("v, piston__mass", "force = v * piston__mass", "return force") + one(
        "v", "force = 0.0 * v", "return force", name="Other", more='    mass = Parameter(1.0, "kg", "a second mass")\n'
    )
    assert seen(composed(tmp_path, body, "own", "other"), "force", v=2.0) == 11.0 + 2.0 * 5.0
