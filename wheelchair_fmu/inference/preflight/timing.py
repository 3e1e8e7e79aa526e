"""Runs whose pushes and readings do not belong to the same time.

A logger that was started by hand is a second early or late, and one that was cut by eye a tenth. No effect of a chair does
that in one run only, but a search finds one that seems to; so such a run is found before the search, and its pushes are read
when the chair felt them. No run is left out for it. What all runs share is the effect `push_force_delay`, and left alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...campaign import Campaign, Clock, Run, covered
from ...campaign.channels import BY_FMU_NAME, BY_NAME, PHASE, PHASE_RATE, PUSH_NAMES
from ...campaign.clocks import Signal, odd_ones_out
from ...campaign.clocks.pushes import ENOUGH, LEAST, ODD, weighted_median
from ...campaign.recorded import PUSHES_CLOCK
from ...errors import SimulationError
from ..estimation.own_constant import own_constant
from ..estimation.score import Projector
from ..estimation.statistics import correlation_time
from ..evidence.evidence import Evidence, RunEvidence
from ..evidence.likelihood import BODY, Likelihood

STROKES = tuple(BY_NAME[name].fmu for name in (PHASE, PHASE_RATE))  # inputs that the pushes tell
SHIFTS = np.arange(0.2, 2.05, 0.2)  # s, each way
FINER = 0.1  # s, either side of the best of these, and how far off it may be
SUSPECT = 2.0  # RMS innovation below which nobody looks
EXPLAINED = 0.25  # share of the mean square innovation that may remain,
HOPEFUL = 0.6  # or so near it
APART = 0.3  # s from the best shift, from where another
UNIQUE = 2.0  # must leave so many times as much, or nobody knows which of them it was
MOST_OF = 0.5  # of what a model leaves above the noise, of all runs or of those that are moved
LEAST_SD = 0.002  # s: no smoother tells a clock better
LIKE_NOISE = 1.1  # RMS innovation of runs of which a model leaves next to nothing


@dataclass(frozen=True)
class Late:
    """The pushes of a run belong `seconds` after the times they have, with a standard deviation of `sd`; where not `unique`,
    whole strokes more or less would do as well."""

    seconds: float
    sd: float
    unique: bool = True


def by_signals(campaign: Campaign) -> dict[str, Late]:
    """Runs that stand out among the others by their signals alone, before any model: see `campaign.clocks.odd_ones_out`."""
    found = odd_ones_out({run.name: tuple(_signals(run)) for run in campaign.runs if _one_clock(run)})
    return {name: Late(shift.seconds, max(shift.se, LEAST_SD), shift.unique) for name, shift in found.items()}


def by_model(likelihood: Likelihood, evidence: Evidence, values: Mapping[str, float]) -> dict[str, Late]:
    """Runs where reading the pushes at another time, and at no third one, explains most of a large error."""
    found = {}
    for e in (e for e in evidence.runs if _one_clock(e.run)):
        if float(np.nanmean(e.r**2)) < SUSPECT**2 or not any(np.ptp(push) > 0 for push in _pushes(e.run).values()):
            continue
        left = _left(likelihood, e, values, [*-SHIFTS, *SHIFTS])
        best = min(left, key=lambda t: left[t])
        if left[best] < HOPEFUL:
            finer = (best + side for side in (-FINER, FINER) if abs(best + side) > SHIFTS[0])
            left |= _left(likelihood, e, values, finer)
            best = min(left, key=lambda t: left[t])
        others = min((share for t, share in left.items() if abs(t - best) > APART), default=np.inf)
        if left[best] < EXPLAINED and abs(best) > SHIFTS[0] and others > UNIQUE * left[best]:
            found[e.run.name] = Late(float(best), FINER)
    return found


def by_slopes(evidence: Evidence, prior_rows: np.ndarray, prior_slopes: np.ndarray) -> dict[str, Late]:
    """Runs whose pushes are a little early or late, where a model explains the rest: `evidence` has sensitivities by what was
    calibrated, of which something was known with residuals (m,) and slopes (m, m), then by what else may come with every
    stroke, and last by a delay, by which all pushes would be felt later.

    One run's shift bends what is calibrated, so calibration is free to go back. Either one run stands out among the shifts of
    all runs, or the shift of one alone explains most of what is left, and of no other nearly as much. It is nobody's shift
    where such runs keep most of their errors with it, or where the motion of a body, the same in all strokes, explains more.
    """
    timed = ((e, part) for e, _, part in evidence.parts() if _one_clock(e.run) and _pushes(e.run))
    parts = [(e, part) for e, part in timed if evidence.S[part, -1].any()]
    if len(parts) < ENOUGH:
        return {}
    m, n, total = len(prior_rows), len(evidence.r), evidence.S.shape[1] - 1
    A, body = np.zeros((n + m, m + len(parts))), np.zeros((n + m, total - m))
    A[:n, :m], A[n:, :m], body[:n] = evidence.S[:, :m], prior_slopes, evidence.S[:, m:-1]
    for i, (_, part) in enumerate(parts, m):
        A[part, i] = evidence.S[part, -1]
    r = np.concatenate([evidence.r, prior_rows])
    found = _standing_out(A, r, parts) or _explaining(A, r, [e.run.name for e, _ in parts], float(r @ r) - n)
    shifts = {i: part for i, (e, part) in enumerate(parts, m) if e.run.name in found}
    if not shifts:
        return {}
    shifted = _left_by(A[:, [*range(m), *shifts]], r)
    before, after = (np.concatenate([left[part] for part in shifts.values()]) for left in (_left_by(A[:, :m], r), shifted))
    explained = float(before @ before - after @ after) > MOST_OF * (float(before @ before) - len(before))
    moved = _left_by(np.hstack([A[:, :m], body]), r)
    return found if explained and not (body.any() and moved @ moved < shifted @ shifted) else {}


def _left_by(A: np.ndarray, r: np.ndarray) -> np.ndarray:
    """What is left of r (n,) by the columns of A (n, k)."""
    return np.asarray(r - A @ (np.linalg.pinv(A.T @ A, hermitian=True) @ (A.T @ r)))


def _standing_out(A: np.ndarray, r: np.ndarray, parts: Sequence[tuple[RunEvidence, slice]]) -> dict[str, Late]:
    """Runs that are early or late beside the others, where the last columns of A are by the shift of each; errors that last
    count as fewer."""
    inverse = np.linalg.pinv(A.T @ A, hermitian=True)
    found = inverse @ (A.T @ r)
    left, shifts, m = r - A @ found, {}, A.shape[1] - len(parts)
    for i, (e, part) in enumerate(parts, m):
        spread = max(1.0, float(np.mean(left[part] ** 2))) * correlation_time(Evidence((e,), ()))
        shifts[e.run.name] = Late(float(found[i]), float(np.sqrt(spread * inverse[i, i])))
    odd = {}
    for name, late in shifts.items():
        others = [o for n, o in shifts.items() if n != name]
        common, se = weighted_median([o.seconds for o in others], [o.sd for o in others])
        away, sd = late.seconds - common, float(np.hypot(late.sd, se))
        if abs(away) > max(ODD * sd, LEAST):
            odd[name] = Late(away, abs(away))  # a first step, from readings that the fit has as well: they settle it
    return odd if 2 * len(odd) < len(shifts) else {}


def _explaining(A: np.ndarray, r: np.ndarray, names: Sequence[str], squares: float) -> dict[str, Late]:
    """The run whose shift alone explains most of these `squares` above the noise's, if there is one."""
    H, g, m = A.T @ A, A.T @ r, A.shape[1] - len(names)
    without = float(g[:m] @ np.linalg.pinv(H[:m, :m], hermitian=True) @ g[:m])
    falls, shifts = [], []
    for i in range(m, A.shape[1]):
        some = [*range(m), i]
        found = np.linalg.pinv(H[np.ix_(some, some)], hermitian=True) @ g[some]
        falls.append(float(g[some] @ found) - without)
        shifts.append(float(found[-1]))
    next_best, best = np.argsort(falls)[-2:]
    plain = falls[best] > MOST_OF * (squares - without) and falls[best] > UNIQUE * falls[next_best]
    late = Late(shifts[best], abs(shifts[best]))
    return {names[best]: late} if plain and abs(late.seconds) > LEAST else {}


def retimed(run: Run, late: Late) -> Run:
    """The run with its pushes when the chair felt them, where they are known; what is left unsure of that stays with it as a
    clock, and no sample is used whose push this may put outside the record."""
    pushes = _pushes(run) | {name: run.inputs[name] for name in STROKES if name in run.inputs}
    inputs = {name: np.interp(run.time - late.seconds, run.time, push) for name, push in pushes.items()}
    clock = Clock(PUSHES_CLOCK, frozenset(), frozenset(pushes), late.sd, late.seconds)
    return covered(replace(run, inputs={**run.inputs, **inputs}, clocks=(*run.clocks, clock)), late.seconds, late.sd)


def unlike_the_others(*evidence: Evidence) -> tuple[str, ...]:
    """A sentence on the one run of which a model leaves much, where it leaves next to nothing of all others: no chair does
    something in one run only. None where there is no such run, or too few others."""
    left = {e.run.name: float(np.sqrt(np.nanmean(e.r**2))) for some in evidence for e in some.runs}
    worst = max(left, key=lambda name: left[name], default="")
    others = [rms for name, rms in left.items() if name != worst]
    if len(others) < ENOUGH or left[worst] < SUSPECT or max(others) > LIKE_NOISE:
        return ()
    return (
        f"{worst}: of this run the last model leaves {left[worst]:.1f} times the noise, and of no other one more than "
        f"{max(others):.2f} times, which no effect of the chair does; see whether its files and clocks are of one ride, and "
        "whether its pushes are recorded from their beginning",
    )


def clocks(*evidence: Evidence) -> dict[str, dict[str, Late]]:
    """For each run whose devices' clocks are uncertain, and each of these, its offset at its own time 0, beside the clock of
    the run's reference. Readings tell how far off it is on average; at time 0 it is as far off, but for its rate."""
    found = {e.run.name: dict(_estimated(e)) for some in evidence for e in some.runs}
    return {run: of for run, of in found.items() if of}


def _estimated(e: RunEvidence) -> Iterator[tuple[str, Late]]:
    beside = [f"clock.{c.device}" for c in e.run.clocks if c.reference]
    for clock in (c for c in e.run.clocks if not c.reference):
        late, se = own_constant(e, f"clock.{clock.device}", *beside)
        yield clock.device, Late(clock.offset + late, float(np.hypot(se, clock.at_zero)))


def _pushes(run: Run) -> dict[str, np.ndarray]:
    return {name: push for name, push in run.inputs.items() if BY_FMU_NAME[name].name in PUSH_NAMES}


def _one_clock(run: Run) -> bool:
    """Were its pushes and readings recorded by one device, whose clock nobody has looked at?"""
    return not run.clocks and run.devices == 1


def _signals(run: Run) -> Iterator[Signal]:
    for name, series in run.channels.items():
        yield Signal("", name, run.time, series)
    for name, push in _pushes(run).items():
        yield Signal("", BY_FMU_NAME[name].name, run.time, push)


def _left(likelihood: Likelihood, e: RunEvidence, values: Mapping[str, float], later: Iterable[float]) -> dict[float, float]:
    """By how many seconds `later` than recorded the pushes are read, the share of the squared innovations that is left."""
    shifts = [float(t) for t in later]
    moved = [_moved(e, seconds) for seconds in shifts]
    again: tuple[RunEvidence | None, ...]
    try:
        again = likelihood.resimulated(Evidence(tuple(moved), ()), values).runs  # all at once, on all cores
    except SimulationError:
        again = tuple(_alone(likelihood, m, values) for m in moved)
    return {t: _share(e, a, t) if a else float("inf") for t, a in zip(shifts, again, strict=True)}


def _moved(e: RunEvidence, seconds: float) -> RunEvidence:
    t, inputs = e.run.time, e.run.inputs
    late = {name: np.interp(t - seconds, t, push) for name, push in inputs.items() if name not in BODY}
    return replace(e, run=replace(e.run, inputs={**inputs, **late}))


def _alone(likelihood: Likelihood, m: RunEvidence, values: Mapping[str, float]) -> RunEvidence | None:
    try:
        return likelihood.resimulated(Evidence((m,), ()), values).runs[0]
    except SimulationError:
        return None


def _share(e: RunEvidence, again: RunEvidence, seconds: float) -> float:
    """What is missing at either end is not counted, nor is what another start of the run could do."""
    t = e.run.time
    inside = (t >= t[0] + abs(seconds)) & (t <= t[-1] - abs(seconds))
    counted = inside[:, None] & np.isfinite(e.r)
    if not counted.any():
        return float("inf")
    start = e.start_S[counted]
    off = Projector(start, np.zeros((start.shape[1], start.shape[1])))
    before, after = (off(r[counted]) for r in (e.r, again.r))
    return float(after @ after / (before @ before))
