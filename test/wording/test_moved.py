"""What a refit moved: beyond its priors, or clearly within wide ones."""

from typing import Any

from pneumo_ros.wording.moved import changed, moved_sentence, moved_table

COULOMB, OPEN, HANGING = "lugre_friction.coulomb_friction", "viscous_friction.coefficient", "pendulum_load.hanging"


def one(before: float, value: float, std: float | None) -> dict[str, Any]:
    """A parameter of a refit."""
    return {"before": before, "value": value, "std": std, "unit": "N"}


REFIT = {
    "moved": ["piston.mass"],
    "parameters": {
        "piston.mass": one(5.0, 5.5, 0.01),
        COULOMB: one(1.16, 1.87, 0.01),  # a worn machine, diagnosed with a file that leaves its friction open
        OPEN: one(1.16, 1.87, 0.4),  # not clear
        HANGING: one(0.0, 0.1, 0.01),  # no share of nothing
        "lugre_friction.static_friction": one(1.5, 1.52, 1e-3),  # too little to matter
        "backlash.gap": one(1e-3, 2e-3, 1e-5),
        "end_stop.stiffness": one(1.0, 2.0, None),
    },
}


def test_what_changed_clearly_within_a_wide_prior_is_named() -> None:
    assert changed(REFIT, ["backlash"]) == [COULOMB]
    said = moved_sentence(REFIT, ["backlash"])
    assert said.endswith(f"Within what the machine file leaves open, it changed {COULOMB} by 10 % or more.")
    table = moved_table(REFIT, ["backlash"])
    assert table is not None
    assert [row[0] for row in table.rows] == ["piston.mass", COULOMB]
    nothing = {**REFIT, "moved": [], "parameters": {OPEN: REFIT["parameters"][OPEN]}}
    assert moved_sentence(nothing).endswith("from what was known before.")
    assert moved_table(nothing) is None
