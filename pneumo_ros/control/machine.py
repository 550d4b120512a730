"""The parameters of the machine file that the control laws use."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property
from types import MappingProxyType

from pneumo_ros.control.arm import ENERGIES, MASSES, Arm, Terms

ATMOSPHERE = "rod_atmospheric_force"  # an effect without parameters
SECOND = {"second_valve", "second_regulator"}  # effects: the valve of chamber b has a command of its own
FLOW = "arctan_flow"  # the flow that laws invert, alone or with a share of choked_flow


ARM = MASSES + ENERGIES  # parameters of an arm that the rod moves


def _known(dotted: str, default: float, absent: float | None = None) -> float:
    """A field for the parameter of that dotted name; its value is `absent` if the machine does not list the effect."""
    metadata = {"dotted": dotted, "absent": default if absent is None else absent}
    value: float = field(default=default, metadata=metadata)
    return value


@dataclass(frozen=True)
class Machine:
    """Parameters of the plant, SI units, meanings and symbols as in its effects; the defaults are the machine axis."""

    mass: float = _known("piston.mass", 5.0)
    area_a: float = _known("piston.area_a", 4.1e-4)
    area_b: float = _known("piston.area_b", 3.0e-4)
    stroke: float = _known("piston.stroke", 2.0)
    supply_pressure: float = _known("air.supply_pressure", 7e5)
    atmospheric_pressure: float = _known("air.atmospheric_pressure", 1e5)
    gas_constant: float = _known("air.gas_constant", 287.0)
    temperature: float = _known("air.temperature", 293.0)
    heat_capacity_ratio: float = _known("air.heat_capacity_ratio", 1.4)
    volume_a: float = _known("chambers.volume_a", 5.1e-4)
    volume_b: float = _known("chambers.volume_b", 4.0e-4)
    filling_coefficient: float = _known("arctan_flow.filling_coefficient", 0.69501e-8, 0.0)
    exhaust_coefficient: float = _known("arctan_flow.exhaust_coefficient", 0.898105e-8, 0.0)
    voltage_gain: float = _known("arctan_flow.voltage_gain", 2.0)
    choked_share: float = _known("choked_flow.blend", 0.0)
    conductance_filling: float = _known("choked_flow.conductance_filling", 5e-9)
    conductance_exhaust: float = _known("choked_flow.conductance_exhaust", 7e-9)
    critical_ratio: float = _known("choked_flow.critical_ratio", 0.3)
    leakage: float = _known("cross_piston_leakage.conductance", 0.0)
    static_friction: float = _known("lugre_friction.static_friction", 100.0, 0.0)
    coulomb_friction: float = _known("lugre_friction.coulomb_friction", 70.0, 1e-3)  # the least that the effect takes
    stribeck_velocity: float = _known("lugre_friction.stribeck_velocity", 0.01)
    bristle_stiffness: float = _known("lugre_friction.bristle_stiffness", 1.4e6)
    bristle_damping: float = _known("lugre_friction.bristle_damping", 50.0, 0.0)
    breakaway_ratio: float = _known("lugre_friction.breakaway_ratio", 0.9)
    drag: float = _known("quadratic_drag.coefficient", 4546.7, 0.0)
    viscous_friction: float = _known("viscous_friction.coefficient", 0.0)
    mass_added: float = _known("payload_mass.mass_added", 0.0)
    load: float = _known("constant_load.load", 0.0)
    null_offset: float = _known("valve_null_offset.offset", 0.0)
    null_offset_b: float = _known("second_valve.offset", 0.0)
    spool_frequency: float = _known("valve_spool_dynamics.angular_frequency", 1000.0)  # 1000: no lag
    spool_damping: float = _known("valve_spool_dynamics.damping_ratio", 0.7)
    arm: tuple[float, ...] = (0.0,) * len(ARM)  # coefficients of `arm_load`
    atmosphere_on_rod: bool = True
    has_flow: bool = True  # whether `FLOW` gives the valve flow
    effects: tuple[str, ...] = field(default=(), compare=False)  # of the machine, for messages

    @classmethod
    def of(cls, effects: Collection[str], values: Mapping[str, float]) -> "Machine":
        """The machine that lists `effects`, from values by dotted name, such as those of a `Model`.

        Parameters that `values` lacks count as absent; names that no law uses are ignored.
        """
        known = {f.name: float(values.get(f.metadata["dotted"], f.metadata["absent"])) for f in _FIELDS}
        arm = tuple(float(values.get(name, 0.0)) for name in ARM)
        return cls(
            **known, arm=arm, atmosphere_on_rod=ATMOSPHERE in effects, has_flow=FLOW in effects, effects=tuple(effects)
        )

    @property
    def closed_signal(self) -> float:
        """The command [V] that closes the valve; laws count their voltages from it."""
        return -self.null_offset + 0.0  # never -0

    @property
    def second_closed(self) -> float | None:
        """The command [V] that closes the valve of chamber b, where each chamber has a valve of its own; else None."""
        return -self.null_offset_b + 0.0 if SECOND & {*self.effects} else None

    @cached_property
    def _arm(self) -> Arm | None:
        return Arm(self.stroke, self.arm) if any(self.arm) else None

    def terms(self, position: float, velocity: float) -> Terms:
        """Moving mass, load and its slope at `position` [m] and `velocity` [m/s]: an arm's change along the stroke."""
        mass = self.mass + self.mass_added
        if self._arm is None:
            return Terms(mass, self.load, 0.0)
        arm = self._arm.terms(position, velocity)
        return Terms(mass + arm.mass, self.load + arm.load, arm.slope)

    @property
    def moving_mass(self) -> float:
        """Everything that accelerates with the piston [kg]; an arm where it is heaviest."""
        return self.mass + self.mass_added + (self._arm.heaviest if self._arm else 0.0)

    def opposing(self, side: float) -> float:
        """Largest load along the stroke [N] against motion to `side`, +1 extends."""
        low, high = self._arm.loads if self._arm else (0.0, 0.0)
        return side * self.load + max(side * low, side * high)

    @property
    def atmosphere(self) -> float:
        """Force of the atmosphere on the rod [N], against extension."""
        return self.atmospheric_pressure * (self.area_a - self.area_b) if self.atmosphere_on_rod else 0.0


_FIELDS = tuple(f for f in fields(Machine) if "dotted" in f.metadata)
_NO_ARM = dict.fromkeys(ARM, 0.0)
PARAMETERS: Mapping[str, float] = MappingProxyType(
    {f.metadata["dotted"]: getattr(Machine, f.name) for f in _FIELDS} | _NO_ARM
)
"""Dotted name -> default, of the parameters that laws use; in the order of a machine file."""

ABSENT: Mapping[str, float] = MappingProxyType({f.metadata["dotted"]: f.metadata["absent"] for f in _FIELDS} | _NO_ARM)
"""Dotted name -> value for a machine without that effect."""
