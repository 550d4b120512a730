"""Effects added by name: the parameters of the model and of the new effects, fitted to recordings together.

First along the measured signals, where candidates start from several shapes and sizes; then by multiple shooting
(`polishing`), which alone determines when the piston breaks away. Its values are taken, and the others say how sure
they are.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from pneumo_ros.blas import on_one_thread
from pneumo_ros.compare.compare import Comparison, compare
from pneumo_ros.diagnose.coordinates import coordinates, forms, starts
from pneumo_ros.diagnose.fitter import Fitter
from pneumo_ros.diagnose.hypothesis import Hypothesis
from pneumo_ros.diagnose.polishing import Progress, polish
from pneumo_ros.diagnose.prediction import typical_error, windowed
from pneumo_ros.diagnose.refining import refine
from pneumo_ros.diagnose.ruler import finest
from pneumo_ros.diagnose.timing import EFFECT, lateness, later
from pneumo_ros.errors import UsageError
from pneumo_ros.plant import Model
from pneumo_ros.runs.clock import on_one_clock
from pneumo_ros.runs.inputs import check_inputs
from pneumo_ros.runs.run import Run
from pneumo_ros.shooting.refit import Estimate, default_free
from pneumo_ros.shooting.windows import fitting_horizon

ROUGHLY = 40  # enough for the model without the effects, whose fit is slow and is not kept


@dataclass(frozen=True)
class Adding:
    """The result of adding effects: the model refitted without and with them, and how both predict the judged runs."""

    effects: tuple[str, ...]
    base: Model
    model: Model
    estimates: dict[str, Estimate]  # of all free parameters of `model`, by dotted name
    before: Comparison = field(repr=False)
    after: Comparison = field(repr=False)
    given: Comparison = field(repr=False)  # the model as it was given
    errors: tuple[float, float, float]  # typical error over the noise floor: as given, refitted, with the effects
    train: tuple[str, ...] = ()
    judged: tuple[str, ...] = ()
    late: float = 0.0  # s, by which a measured force was delayed, as positions are recorded after it

    @property
    def held_out(self) -> bool:
        """Whether the judged runs took no part in the fit."""
        return not set(self.train) & set(self.judged)


@on_one_thread()
def add(
    model: Model,
    effects: Sequence[str],
    train: Sequence[Run],
    held: Sequence[Run] = (),
    *,
    threads: int = 2,
    progress: Progress | None = None,
    horizon: float | None = None,
) -> Adding:
    """Add `effects` to `model`, refit all free parameters to `train`, and predict `held`, or `train` if it is empty.

    `horizon` [s]: length of the windows of these predictions; by default 1 s, or less where a run is shorter.

    Raises UsageError for no run, no effect, an unknown effect, an effect that the model has, and an effect that
    conflicts with its others; DataError when a run does not fit the model, or lacks a signal that an
    effect reads.
    """
    check_addable(model, effects)
    if not train:
        raise UsageError("effects are fitted to recordings; give at least one")
    larger = model.with_effects([*model.effects, *effects])
    for run in (*train, *held):
        check_inputs(larger, run)
    tell = progress or (lambda share, text: None)
    tell(0.0, "refitting the model as given")
    runs = on_one_clock([*train, *held])
    train, held, horizon = runs[: len(train)], runs[len(train) :], fitting_horizon(runs, horizon)
    late = lateness(model, train) if EFFECT not in effects else 0.0
    train, held = ([later(run, late) for run in runs] for runs in (train, held))
    fading = [name for name in effects if coordinates(model.library.find(name))]
    fitter = Fitter(model, train, candidates=fading)
    base = larger = fitter.refit(model)
    if len(fading) < len(effects):
        plain = [name for name in effects if name not in fading]
        fitter = Fitter(model.with_effects([*model.effects, *plain]), train, candidates=fading)
        larger = fitter.refit(fitter.start)
    for k, name in enumerate(fading):
        tell(0.1 + 0.1 * k / len(fading), f"fitting {name}")
        larger = _with(fitter, larger, name, horizon)
    if fitter.known(base).names:  # none: sealed chambers of known volume
        base = polish(fitter, base, train, ROUGHLY, threads=threads, progress=_part(tell, 0.2, 0.5, "without")).model
    along = {} if larger.self_driven else estimates_along(fitter, larger)  # a loop's equations are biased
    found = polish(fitter, larger, train, threads=threads, progress=_part(tell, 0.5, 0.85, "with"))
    least = {n: finest(found.model, n) for n in found.estimates if n.partition(".")[0] in effects}
    judged, compared, errors = held or train, list[Comparison](), list[float]()
    for k, one in enumerate((model, base, found.model)):
        tell(0.85 + 0.05 * k, "predicting the recordings")
        compared.append(compare(one, judged, horizon))
        errors.append(typical_error(windowed(one, judged, horizon)))
    return Adding(
        tuple(effects), base, found.model, agreed(found.estimates, along, least), compared[1], compared[2], compared[0],
        (errors[0], errors[1], errors[2]), tuple(run.name for run in train), tuple(run.name for run in judged), late,
    )  # fmt: skip


def check_addable(model: Model, effects: Sequence[str]) -> None:
    """UsageError for effects that cannot be added to `model`."""
    if not effects:
        raise UsageError("name an effect to add; see: pneumo effects")
    for name in effects:
        entered = model.library.find(name).entered
        if name in model.effects:
            raise UsageError(f"{name} is in '{model.name}' already; pneumo compare --refit fits what a model has")
        if list(effects).count(name) > 1:
            raise UsageError(f"{name} is named twice")
        if entered:
            raise UsageError(
                f"{name} is not fitted to recordings: the machine file says it. Add {name} to its 'effects', and a "
                f"section such as {entered}; then type: pneumo compare"
            )
    larger = model.with_effects([*model.effects, *effects])
    for name in effects:
        if not coordinates(model.library.find(name)) and any(n.startswith(f"{name}.") for n in default_free(larger)):
            raise UsageError(
                f"{name} cannot be fitted: none of its parameters says where it adds nothing, as "
                "Parameter(..., neutral=0.0) does; put it into the machine file instead"
            )


def _with(fitter: Fitter, model: Model, name: str, horizon: float) -> Model:
    """The model with one more effect, fitted along the signals from the best of several shapes."""
    fit = fitter.fit(model)
    own = coordinates(model.library.find(name))
    begin = [
        Hypothesis(name, form, u, np.zeros(len(fit.names)), fit.residual) for form in forms(own) for u in starts(form)
    ]
    best = max(refine(fit, begin), key=lambda h: h.likelihood)
    return fitter.simplest(fitter.refit(fitter.extended(model, best)), name, horizon)


def _part(tell: Progress, first: float, last: float, what: str) -> Progress:
    return lambda share, _: tell(first + (last - first) * share, f"refitting {what} what is added, by prediction")


def agreed(
    predicted: Mapping[str, Estimate], along: Mapping[str, Estimate], least: Mapping[str, float]
) -> dict[str, Estimate]:
    """Estimates by prediction, as unsure as those along the signals of the same recordings show them to be.

    What two estimates of one parameter differ by beyond both deviations is an error of the model, which neither of them
    holds (the variance between studies of DerSimonian and Laird 1986, all of it to each). Without an estimate along
    the signals, or where they do not determine it, the deviation stays. `least`: deviations to be added to it.
    """
    found = {}
    for name, one in predicted.items():
        other = along.get(name, one)
        beyond = (one.value - other.value) ** 2 - other.std**2 if np.isfinite(other.std) else 0.0
        std = float(np.hypot(np.sqrt(max(one.std**2, beyond)), least.get(name, 0.0)))
        found[name] = replace(one, std=std, low=one.value - 1.96 * std, high=one.value + 1.96 * std)
    return found


def estimates_along(fitter: Fitter, model: Model) -> dict[str, Estimate]:
    """Estimates of the free parameters of a model that `fitter` fitted, against their priors."""
    known = fitter.known(model)
    spread = fitter.deviations(model)
    each = zip(known.names, known.centre.tolist(), known.prior.tolist(), strict=True)
    return {n: _estimate(model[n], spread[n], centre, prior) for n, centre, prior in each}


def _estimate(value: float, spread: float, before: float, prior: float) -> Estimate:
    return Estimate(value, spread, value - 1.96 * spread, value + 1.96 * spread, before, prior)
