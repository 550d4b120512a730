"""Parameters as ROS describes them, from the data of their settings."""

import math

from pneumo_ros.axis.setting import Setting
from pneumo_ros.ros.parameters import descriptor

MASS = Setting("mass", 5.0, "moving mass", "kg", 0.1)
SHAPE = Setting("shape", "sine", "of the reference", choices=("sine", "steps"))
SEED = Setting("seed", 0, "of the noise", "", 0, 100)


def test_the_descriptor_has_unit_and_a_finite_range_that_holds_the_value() -> None:
    described = descriptor(MASS, 1e5)
    assert described.description == "moving mass [kg]"
    span = described.floating_point_range[0]
    assert span.from_value == 0.1
    assert 1e5 < span.to_value < math.inf
    assert span.step == 0.0
    assert not described.read_only
    assert "sine, steps" in descriptor(SHAPE, "sine").additional_constraints
    assert descriptor(SEED, 0).integer_range[0].to_value == 100
    assert descriptor(Setting("rate", 1.0, "", live=False), 1.0).read_only
