"""All clocks of a run from what each two of its devices say."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from .pairs import Pair, pair
from .signals import Device, Signal, devices
from .views import KINDS

CURE = "give its offset by hand (an event that both show, such as the first movement, tells it)"
SHARED = 0.5  # correlation of two pairs' errors that comes from the device that is in both
APART = 4.0  # standard errors, and
MATTERS = 0.02  # s, by which a pair may miss what the others say of it before nobody is believed


@dataclass(frozen=True, eq=False)
class Clock:
    """`offset` is to be added to the device's file time to give the reference's (s), which runs faster by `drift` (s/s):
    common = offset + (1 + drift) · file time. With standard errors. `own` is the part of the offset's that is this device's:
    the rest is the reference's, and so the same in all others. Where not `sure`, `why` says in a sentence what is missing
    and what cures it, and the offset is the best guess (NaN where there is none), not to be used unseen. `evidence` are the
    pairs that this device is in."""

    offset: float
    se: float
    own: float
    drift: float
    drift_se: float
    sure: bool
    why: str
    evidence: tuple[Pair, ...]


def offsets(signals: Iterable[Signal], *, reference: str | None = None) -> dict[str, Clock]:
    """The clock of each device of one run beside that of `reference`, by default the device of the first signal."""
    found = devices(signals)
    if not found:
        return {}
    reference = reference or next(iter(found))
    used, seen = _chosen(found)
    guesses = _joined(found, used, [p for p in seen if not p.unique])
    own = _component(reference, used)
    solved = _solve(list(found), reference, [*used, *guesses])
    bad = _misfits(solved, used)
    clocks = {}
    for name in found:
        evidence = tuple(p for p in seen if name in (p.a, p.b))
        why = _doubt(name, reference, own, used, bad, evidence)
        clocks[name] = Clock(*solved[name], sure=not why, why=why or _grounds(name, reference, used), evidence=evidence)
    return clocks


def _chosen(found: Mapping[str, Device]) -> tuple[list[Pair], list[Pair]]:
    """The pairs to rely on, and all that were looked at. Of each kind only what joins devices that better kinds left apart, and
    of pushes and of a part of the motion only the best: their errors are the rider's, and the same in all."""
    used: list[Pair] = []
    seen: list[Pair] = []
    for kind in KINDS:
        groups = {name: _component(name, used) for name in found}
        apart = [(a, b) for a, b in combinations(found, 2) if b not in groups[a]]
        new = [p for a, b in apart if (p := pair(found[a], found[b], kind)) is not None]
        seen += new
        unique = sorted((p for p in new if p.unique), key=lambda p: p.se)
        used += unique if kind == KINDS[0] else _joined(found, used, unique)
    return used, seen


def _joined(found: Iterable[str], used: Sequence[Pair], more: Iterable[Pair]) -> list[Pair]:
    """Of more pairs those that join what is still apart, the first that do."""
    tree: list[Pair] = []
    for p in more:
        if p.b not in _component(p.a, [*used, *tree]):
            tree.append(p)
    return tree


def _component(name: str, pairs: Sequence[Pair]) -> set[str]:
    reached, grown = {name}, True
    while grown:
        new = {other for p in pairs for one, other in ((p.a, p.b), (p.b, p.a)) if one in reached} - reached
        reached |= new
        grown = bool(new)
    return reached


def _solve(names: Sequence[str], reference: str, pairs: Sequence[Pair]) -> dict[str, tuple[float, float, float, float, float]]:
    """Offset, standard error, the device's own part of it, drift and standard error of each device that pairs lead to."""
    offset, covariance = _least_squares(names, reference, pairs, [p.lag for p in pairs], [p.se for p in pairs])
    drift, of_drift = _least_squares(names, reference, pairs, [p.drift for p in pairs], [p.drift_se for p in pairs])
    columns = (offset, *_errors([n == reference for n in names], covariance), drift, np.sqrt(np.diag(of_drift)))
    return {n: (float(a), float(b), float(c), float(d), float(e)) for n, a, b, c, d, e in zip(names, *columns, strict=True)}


def _errors(reference: Sequence[bool], covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Standard errors (n,) of offsets, and each device's own part: what offsets have in common is the `reference`'s error (n,),
    as they are all beside it. Where two devices are all there are, it is the other one's."""
    variance = np.diag(covariance)
    others = np.flatnonzero(np.isfinite(variance) & ~np.array(reference))
    shared = 0.0
    if len(others) > 1:
        apart = covariance[np.ix_(others, others)][np.triu_indices(len(others), 1)]
        shared = float(np.clip(np.mean(apart), 0.0, variance[others].min()))
    return np.sqrt(variance), np.sqrt(np.where(reference, shared, variance - shared))


def _least_squares(
    names: Sequence[str], reference: str, pairs: Sequence[Pair], lags: Sequence[float], ses: Sequence[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Weighted least squares of differences between nodes, with their covariance (n, n); it knows that pairs which share a
    device share its errors, and grows where the pairs disagree (Birge 1932). NaN where nothing leads."""
    reached = _component(reference, pairs)
    nodes = [n for n in names if n in reached and n != reference]
    value, errors = np.full(len(names), np.nan), np.full((len(names), len(names)), np.nan)
    at = [i for i, n in enumerate(names) if n == reference]
    value[at], errors[np.ix_(at, at)] = 0.0, 0.0
    ours = [i for i, p in enumerate(pairs) if p.a in reached]
    if not nodes:
        return value, errors
    incidence = np.array([[(n == pairs[i].b) - (n == pairs[i].a) for n in nodes] for i in ours], float)
    ends = np.array([[(n == pairs[i].b) - (n == pairs[i].a) for n in names] for i in ours], float)
    sd, lag = np.array([ses[i] for i in ours]), np.array([lags[i] for i in ours])
    solver = np.linalg.pinv(incidence / sd[:, None]) / sd
    found = solver @ lag
    overlap = SHARED * ends @ ends.T
    np.fill_diagonal(overlap, 1.0)
    covariance = solver @ (overlap * np.outer(sd, sd)) @ solver.T
    np.fill_diagonal(covariance, np.maximum(np.diag(covariance), 0))  # which rounding may leave below nothing
    spare = len(ours) - len(nodes)
    birge = max(1.0, float(np.sum(((lag - incidence @ found) / sd) ** 2)) / spare) if spare else 1.0
    places = [list(names).index(n) for n in nodes]
    value[places], errors[np.ix_(places, places)] = found, birge * covariance
    return value, errors


def _misfits(solved: Mapping[str, tuple[float, ...]], pairs: Sequence[Pair]) -> list[Pair]:
    """Pairs that the others contradict."""
    miss = [(abs(p.lag - (solved[p.b][0] - solved[p.a][0])), p) for p in pairs]
    return [p for d, p in miss if d > max(APART * p.se, MATTERS)]


def _doubt(
    name: str, reference: str, own: set[str], used: Sequence[Pair], bad: Sequence[Pair], evidence: Sequence[Pair]
) -> str:
    """A sentence where the device's clock is not sure, else nothing."""
    if name == reference:
        return ""
    if name in own:
        around = [p for p in bad if name in (p.a, p.b)]
        if around:
            words = "; ".join(f"{p.words} say {p.lag:+.3f} s" for p in around)
            return f"what its devices share does not agree by more than {1000 * MATTERS:.0f} ms: {words}; {CURE}"
        return ""
    best = max((p for p in evidence if not p.unique), key=lambda p: p.ahead, default=None)
    if best is None:
        other = reference if len(own) > 1 else "any other device"
        return f"{name} measured nothing that sets its clock beside that of {other}; {CURE}"
    other = f", and {best.rival:+.2f} s nearly as well" if best.rival is not None else ""
    return f"{best.words} fit best with {best.lag:+.2f} s between their clocks{other}; {CURE}"


def _grounds(name: str, reference: str, used: Sequence[Pair]) -> str:
    if name == reference:
        return "the reference"
    best = min((p for p in used if name in (p.a, p.b)), key=lambda p: p.se)
    other = best.b if best.a == name else best.a
    return f"by {best.how}, with {other}"
