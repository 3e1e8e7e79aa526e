"""Before any physics, and once more after it: columns that are not what they are called, and clocks that are wrong."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...campaign.recorded import PUSHES_CLOCK
from ..estimation.problem import Fit, Problem
from ..models.factory import STROKE_PHASE
from ..models.hypothesis import Model
from ..models.models import Models
from ..preflight.timing import Late, by_model, by_signals, by_slopes
from ..preflight.wiring import wiring
from ..residual.staircase import Step

LED = 3  # times that forces, noise and calibration are found one from another, at most
Clocks = Mapping[str, Mapping[str, Late]]  # by run and device, where they are uncertain


@dataclass(frozen=True)
class Beginning:
    """The models that a search may ask for, the calibrated one, and the staircase up to there; what was found odd in columns;
    and by run how late pushes are that are read at another time than they were recorded at."""

    models: Models
    calibrated: Model
    ladder: tuple[Step, ...]
    notes: tuple[str, ...] = ()
    retimed: Mapping[str, Late] = field(default_factory=dict)

    def heard(self, clocks: Clocks) -> tuple[str, ...]:
        """What there is to say of columns and clocks, once it is known what these are."""
        return (*self.notes, *(_late(run, clocks[run][PUSHES_CLOCK], late.unique) for run, late in self.retimed.items()))


def begin(models: Models) -> Beginning:
    """Calibrate, with the noise that the data show.

    Channels that are not what they are called are left out; pushes that belong to another time than the readings of their run
    are read at that time.
    """
    models.say("calibrating")
    begun = _begun_led(models) if models.factory.leads else _begun(models)
    return replace(begun, models=begun.models.with_doubles(begun.calibrated.fit))


def _begun(models: Models) -> Beginning:
    found = dict(by_signals(models.campaign))
    models = replace(models, factory=models.factory.retimed(found))
    columns, recorded = wiring(models.likelihood(), models.factory.given), models.campaign.runs
    if columns.wrong:
        models = replace(models, factory=models.factory.without(columns.wrong))
    told = {run.name for run in models.campaign.runs}
    empty = (
        f"{run.name}: nothing else was measured in it, so that it says nothing" for run in recorded if run.name not in told
    )
    begun = first_steps(models)
    if columns.trusted:
        models, (base, held) = begun.models, (begun.calibrated.fit, begun.calibrated.heldout)
        late = [by_model(models.likelihood(), e, base.values) for e in (base.evidence, held)]
        more = late[0] | late[1]
        if more:
            found |= more
            begun = first_steps(replace(models, factory=models.factory.retimed(more)))
    again = begun.models.with_noise_of(begun.calibrated.fit)
    return replace(first_steps(again) if again else begun, notes=(*columns.notes, *empty), retimed=found)


def _begun_led(models: Models) -> Beginning:
    """The same where forces lead the runs: columns and clocks were looked at before, and how strong the forces are may be known
    only once all is calibrated beside them."""
    begun = first_steps(models)
    for _ in range(LED):
        again = begun.models.with_noise_of(begun.calibrated.fit)
        if again is None:
            break
        begun = first_steps(again)
    return begun


def late_by_slopes(models: Models, effects: Sequence[str], named: Container[str], base: Fit) -> dict[str, Late]:
    """How late the pushes of the runs are that the model with these effects shows to be a little early or late. None where a
    delay of all pushes is `named`, or nobody is to estimate one; one that only helps may come of a single run's."""
    w = models.factory
    delay, name = next(((e.id, n) for e in w.catalogue.values() if e.delays_record for n in w.parameters(e.id)), ("", ""))
    if not name or delay in named or w.leads:
        return {}
    if delay in effects:
        effects = [e for e in effects if e != delay]
        base = models.fitted(effects, base.values)
    found = _late_beside(models, (*effects, delay), base, (), name)
    bodies = [e.id for e in w.catalogue.values() if e.asks(STROKE_PHASE) and e.id not in effects]
    if not found or not bodies:
        return found
    return _late_beside(models, (*effects, *bodies, delay), base, [n for e in bodies for n in w.parameters(e)], name)


def _late_beside(models: Models, effects: Sequence[str], base: Fit, body: Sequence[str], delay: str) -> dict[str, Late]:
    """The same by a model with these effects, of which the parameters of the `body`'s and the `delay` are not in the fit."""
    likelihood, theta = models.likelihood(effects), np.array([base.values[n] for n in base.names])
    prior = Problem(likelihood, base.names).prior
    evidence = likelihood.evidence(models.campaign.runs, base.values, (*base.names, *body, delay))
    return by_slopes(evidence, prior.rows(theta), prior.slopes)


def first_steps(models: Models) -> Beginning:
    """The calibrated model, and the staircase up to there, with the noise as it is known."""
    models, base, nominal, nominal_held = models.calibrated()
    calibrated = Step.of("calibrated", base.fit.evidence, base.heldout, base.fit.values)
    return Beginning(models, base, (Step.of("nominal", nominal, nominal_held, {}), calibrated))


def _late(run: str, late: Late, unique: bool) -> str:
    side, moved = ("early", "later") if late.seconds > 0 else ("late", "earlier")
    strokes = "" if unique else " (whole strokes more or less would do as well)"
    return (
        f"{run}: its pushes were recorded {1000 * abs(late.seconds):.0f} ± {1000 * late.sd:.0f} ms too {side} for what was "
        f"measured{strokes}, and are read that much {moved}; `wheelchair sync` looks for it, and "
        f"clocks = {{ {PUSHES_CLOCK} = {late.seconds:.3f} }} in the run says so for good"
    )
