"""The control laws by their names in nodes and commands."""

from pneumo_ros.control.cascade import Cascade
from pneumo_ros.control.law import Law
from pneumo_ros.control.pid import Pid
from pneumo_ros.control.pva import Pva
from pneumo_ros.control.sliding_mode import SlidingMode

LAWS: dict[str, type[Law]] = {"pid": Pid, "pva": Pva, "cascade": Cascade, "sliding_mode": SlidingMode}
