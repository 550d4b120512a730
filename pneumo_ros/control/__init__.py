"""Control laws, references and the lockstep closed loop: pure Python, shared by node, simulation and benchmarks."""

from pneumo_ros.control.cascade import Cascade
from pneumo_ros.control.closed_loop import Record, closed_loop
from pneumo_ros.control.gain import Gain
from pneumo_ros.control.law import Law
from pneumo_ros.control.laws import LAWS
from pneumo_ros.control.machine import Machine
from pneumo_ros.control.measurement import Measurement
from pneumo_ros.control.pid import Pid
from pneumo_ros.control.pva import Pva
from pneumo_ros.control.setpoint import Reference, Setpoint
from pneumo_ros.control.sliding_mode import SlidingMode
from pneumo_ros.control.valve import ValveInverse

__all__ = [
    "LAWS",
    "Cascade",
    "Gain",
    "Law",
    "Machine",
    "Measurement",
    "Pid",
    "Pva",
    "Record",
    "Reference",
    "Setpoint",
    "SlidingMode",
    "ValveInverse",
    "closed_loop",
]
