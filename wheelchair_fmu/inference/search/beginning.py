"""Before any physics, and once more after it: columns that are not what they are called, and clocks that are wrong."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence

import numpy as np

from ...campaign.recorded import PUSHES_CLOCK
from ..estimation.fit import Fit, Problem
from ..evidence.evidence import Evidence
from ..preflight.timing import Late, by_model, by_signals, by_slopes, clocks
from ..preflight.wiring import wiring
from ..residual.staircase import Step
from .search import Search

LED = 3  # times that forces, noise and calibration are found one from another, at most


def begin(search: Search, say: Callable[[str], None]) -> tuple[Fit, Evidence, list[Step]]:
    """Calibrate, with the noise that the data show: (fit, held out, the staircase's first two steps).

    Channels that are not what they are called are left out; pushes that belong to another time than the readings of their run
    are read at that time.
    """
    say("calibrating")
    w = search.factory
    if w.leads:
        return _begin_led(search)
    found = dict(by_signals(w.campaign))
    w.retime(found)
    columns = wiring(w.likelihood(), w.given)
    if columns.wrong:
        w.leave_out(channels=columns.wrong)
    base, held, ladder = first_steps(search)
    if columns.trusted:
        more = by_model(w.likelihood(), base.evidence, base.values) | by_model(w.likelihood(), held, base.values)
        if more:
            w.retime(more)
            found |= more
            base, held, ladder = first_steps(search)
    if search.reestimate_noise(base):
        base, held, ladder = first_steps(search)
    search.retimed |= found
    search.notes = list(columns.notes)
    return base, held, ladder


def _begin_led(search: Search) -> tuple[Fit, Evidence, list[Step]]:
    """The same where forces lead the runs: columns and clocks were looked at before, and how strong the forces are may be known
    only once all is calibrated beside them."""
    base, held, ladder = first_steps(search)
    for _ in range(LED):
        if not search.reestimate_noise(base):
            break
        base, held, ladder = first_steps(search)
    return base, held, ladder


def retime_by_slopes(search: Search, effects: Sequence[str], named: Container[str], base: Fit) -> bool:
    """Read the pushes in time of the runs that the model with these effects shows to be a little early or late; are there any?
    Not while a delay of all pushes is `named`, or nobody is to estimate one; one that only helps may come of a single run's."""
    w = search.factory
    delay, name = next(((e.id, n) for e in w.catalogue.values() if e.delays_record for n in w.parameters(e.id)), ("", ""))
    if not name or delay in named or w.leads:
        return False
    if delay in effects:
        effects = [e for e in effects if e != delay]
        base = search.refit(effects, base.values)
    likelihood, theta = w.likelihood((*effects, delay)), np.array([base.values[n] for n in base.names])
    prior = Problem(likelihood, base.names).prior
    evidence = likelihood.evidence(w.campaign.runs, base.values, (*base.names, name))
    found = by_slopes(evidence, prior.rows(theta), prior.slopes)
    w.retime(found)
    search.retimed |= found
    return bool(found)


def settle_clocks(search: Search, *evidence: Evidence) -> None:
    """Keep what clocks are by this evidence, of fitted and of held-out runs, and say which pushes were read at another time."""
    search.clocks = {run: of for e in evidence for run, of in clocks(e).items()}
    search.notes += [_late(run, search.clocks[run][PUSHES_CLOCK], late.unique) for run, late in search.retimed.items()]


def first_steps(search: Search) -> tuple[Fit, Evidence, list[Step]]:
    """The calibrated fit, its held-out evidence, and the staircase up to there, with the noise as it is known."""
    base, held, nominal, nominal_held = search.calibrate()
    return base, held, [Step.of("nominal", nominal, nominal_held), Step.of("calibrated", base.evidence, held)]


def _late(run: str, late: Late, unique: bool) -> str:
    side, moved = ("early", "later") if late.seconds > 0 else ("late", "earlier")
    strokes = "" if unique else " (whole strokes more or less would do as well)"
    return (
        f"{run}: its pushes were recorded {1000 * abs(late.seconds):.0f} ± {1000 * late.sd:.0f} ms too {side} for what was "
        f"measured{strokes}, and are read that much {moved}; `wheelchair sync` looks for it, and "
        f"clocks = {{ {PUSHES_CLOCK} = {late.seconds:.3f} }} in the run says so for good"
    )
