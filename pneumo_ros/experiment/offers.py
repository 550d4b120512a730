"""Experiments that may distinguish effects, and the conditions of their recording."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from pneumo_ros.experiment.catalogue import EXPERIMENTS, make_programme
from pneumo_ros.experiment.programme import Programme
from pneumo_ros.experiment.telling import BLOCK_PISTON, VENT
from pneumo_ros.plant import Model

LOW_SUPPLY = 0.75  # of the gauge supply pressure
_BLOCKED = 1e5  # N, friction that holds a blocked piston


@dataclass(frozen=True)
class Part:
    """One programme under conditions that differ from the model's: parameter values by dotted name."""

    programme: Programme
    conditions: Mapping[str, float]
    blocked: bool = False  # the piston cannot move

    def machine(self, model: Model) -> Model:
        """`model` under these conditions, for its equations."""
        return model.with_parameters(self.conditions)

    def held(self, model: Model) -> Model:
        """`model` under these conditions, for simulation: a blocked piston has very large friction."""
        lugre = ("lugre_friction.static_friction", "lugre_friction.coulomb_friction")
        return self.machine(model).with_parameters(dict.fromkeys(lugre, _BLOCKED) if self.blocked else {})


@dataclass(frozen=True)
class Offer:
    """An experiment on the menu: purpose, name to run it by, preparation by hand, and parts."""

    name: str
    purpose: str
    experiment: str
    prepare: str
    parts: tuple[Part, ...]

    @property
    def programme(self) -> Programme:
        """The programme to run, with its preparations."""
        return replace(self.parts[0].programme, prepare=self.prepare)


def menu(model: Model) -> list[Offer]:
    """Every experiment of the catalogue, and full strokes at two supply pressures.

    Raises UsageError for a model without valve.
    """
    offers = [_single(name, model) for name in EXPERIMENTS if name != "blocked-triangle" or "z" in model.states]
    return [*offers, _two_supplies(model)]


def conditions(programme: Programme, model: Model) -> Part:
    """A programme with the conditions that its preparations create for `model`."""
    vented = {"air.supply_pressure": model["air.atmospheric_pressure"]} if programme.prepare == VENT else {}
    return Part(programme, vented, blocked=programme.prepare == BLOCK_PISTON and "z" in model.states)


def _single(name: str, model: Model) -> Offer:
    programme = make_programme(name, model)
    part = conditions(programme, model)
    return Offer(name, EXPERIMENTS[name].purpose, name, programme.prepare, (part,))


def _two_supplies(model: Model) -> Offer:
    programme = make_programme("full-strokes", model)
    full, atmosphere = model["air.supply_pressure"], model["air.atmospheric_pressure"]
    low = round(atmosphere + LOW_SUPPLY * (full - atmosphere), -3)
    by_hand = f"run it twice, at the usual supply pressure and at {1e-3 * low:.0f} kPa absolute"
    parts = (Part(programme, {}), Part(programme, {"air.supply_pressure": low}))
    purpose = "full strokes at two supply pressures: friction of seals that the pressure presses on"
    return Offer("two-supplies", purpose, "full-strokes", by_hand, parts)
