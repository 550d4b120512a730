"""A machine as MJCF: its moving mass and its load on a slide joint, to which `pneumo_ros.couple` attaches the cylinder.

MuJoCo's own `cylinder` actuator knows no valve, no gas of changing volume and no friction. So an MJCF file alone is the
mechanism; one line of Python gives it this machine's cylinder.
"""

from xml.sax.saxutils import escape, quoteattr

from pneumo_ros import __version__
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model

JOINT = "piston"
NO_SLIDE = ("arm_load", "imposed_motion", "measured_load", "load_compliance")  # effects of other mechanisms


def mjcf_text(model: Model, machine: str) -> str:
    """The MJCF of a model whose machine file is `machine`, which a comment names.

    Raises UsageError for a machine without chambers or one that turns, and for loads that a slide joint does not have.
    """
    if model.force_driven:
        raise UsageError(f"{model.name} has no chambers; mjcf takes a machine file with a section 'chambers'")
    model.require_metres("mjcf")
    other = [name for name in model.effects if name in NO_SLIDE]
    if other:
        raise UsageError(
            f"{model.name} has {other[0]}, which a slide joint is not: put its cylinder on the MJCF of that mechanism, "
            "see docs/coupling.md"
        )
    mass = model["piston.mass"] + model.parameters.get("payload_mass.mass_added", 0.0)
    load = model.parameters.get("constant_load.load", 0.0)
    stroke, radius = model["piston.stroke"], (model["piston.area_a"] / 3.14159265) ** 0.5
    return _TEXT.format(
        name=quoteattr(model.name), version=__version__, machine=escape(machine).replace("--", "- -"), joint=JOINT,
        mass=mass, gravity=-load / mass, half=0.5 * stroke, radius=radius, rod=0.4 * radius,
        inertia=max(mass * radius**2, 1e-6), load=load,
    )  # fmt: skip


_TEXT = """<?xml version="1.0"?>
<!-- Mechanism of the machine {machine}, written by pneumo export {version}. SI units; positive positions
     extend the rod. Its cylinder, with valve, gas and friction, is attached in Python (pip install pneumo_ros[mujoco]):

       import mujoco
       from pneumo_ros.couple.mujoco import Cylinders, Mount
       from pneumo_ros.plant import load_model
       model = mujoco.MjModel.from_xml_path("THIS FILE")
       data = mujoco.MjData(model)
       cylinders = Cylinders(model, data, {{"axis": Mount(load_model("{machine}"), joint="{joint}")}})
       cylinders.step({{"axis": 2.5}})  (volts; in place of mj_step)

     The constant load of {load:.6g} N is a gravity along the axis; the stops are those of the cylinder. -->
<mujoco model={name}>
  <option timestep="0.001" integrator="implicitfast" gravity="{gravity!r} 0 0"/>
  <worldbody>
    <body name="tube">
      <geom type="cylinder" fromto="-{half!r} 0 0 {half!r} 0 0" size="{radius:.6g}" rgba="0.7 0.72 0.75 0.4"
            contype="0" conaffinity="0"/>
      <site name="base_pin" pos="-{half!r} 0 0"/>
    </body>
    <body name="rod">
      <joint name="{joint}" type="slide" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia:.6g} {inertia:.6g} {inertia:.6g}"/>
      <geom type="cylinder" fromto="0 0 0 {half!r} 0 0" size="{rod:.6g}" rgba="0.45 0.47 0.5 1"
            contype="0" conaffinity="0"/>
      <site name="rod_pin" pos="{half!r} 0 0"/>
    </body>
  </worldbody>
</mujoco>
"""
