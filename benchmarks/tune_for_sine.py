"""Finds pid_for_sine.yaml and cascade_for_sine.yaml: the search of `pneumo tune`, on the sine of the benchmark alone.

`pneumo tune` also considers moves and a harsher machine, so that its gains are not the best for this
sine. Here PID and the cascade get the best gains for the sine, on exactly the machine of their file.

    python benchmarks/tune_for_sine.py
"""

from collections.abc import Mapping
from functools import partial

from control_cases import AXIS, HERE, SINE

from pneumo_ros.command.rated_motions import stepper
from pneumo_ros.control import Law
from pneumo_ros.control.control_file import Control, load_control
from pneumo_ros.control.tuning import RatedMotion, Search, costs_here

EVALUATIONS = 80  # as `pneumo tune`
ALONE = RatedMotion(partial(stepper, AXIS), SINE, 24.0, 4.0)  # the first fifth of a period is not judged, as there


def found(law: str) -> Control:
    """The law with the gains found by a search that starts at the shipped ones."""
    begin = load_control(law)

    def make(gains: Mapping[str, float]) -> Law:
        return Control(law, {**begin.gains, **gains}, begin.smoothing).make(AXIS.effects, AXIS.parameters)

    search = Search(make({}), costs_here(make, [ALONE]), EVALUATIONS)
    gains = search.run()
    print(f"{law}: cost {search.first:.3f} -> {search.least:.3f}")
    return Control(law, {**begin.gains, **gains}, begin.smoothing)


if __name__ == "__main__":
    for name in ("pid", "cascade"):
        heading = f"Gains of {name} for the sine of the control benchmark alone: python benchmarks/tune_for_sine.py"
        (HERE / f"{name}_for_sine.yaml").write_text(found(name).text(heading), encoding="utf-8")
