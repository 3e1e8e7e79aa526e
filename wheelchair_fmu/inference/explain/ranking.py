"""A diagnosis as records: for JSON, with the keys that are fixed, and for tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..decision.diagnosis import Diagnosis
from ..estimation.interval import NORMAL
from ..estimation.score import Score
from ..estimation.statistics import cosines, estimates, finite
from ..search.candidate import Candidate
from ..search.rounds import Round

SIGNIFICANT = 0.05  # level at which a slight effect is said to show
MAKERS = 3  # values that are said to make up for an effect
RIVALS = 4  # that are listed of an effect, if their
ALIKE_AT_ALL = 0.5  # cosine is larger


def as_json(d: Diagnosis) -> dict[str, Any]:
    """The diagnosis with the keys that are fixed for `diagnose --json`."""
    return {
        "campaign": d.campaign,
        "verdict": d.verdict,
        "effects": list(d.effects),
        "ties": [list(t) for t in d.ties],
        "odds": list(d.odds),
        "larger": [{"effect": other.effect, "times": other.times, "odds_against": other.against} for other in d.larger],
        "ranking": ranking(d),
        "groups": groups(d),
        "ladder": [step.as_json() for step in d.ladder],
        "leftover": leftover_json(d),
        "next_experiment": d.next_experiment,
        "to_fit": d.to_fit,
        "rests_on": [one._asdict() for one in d.rests_on],
        "seen": d.seen,
        "sync": {
            run: {device: {"offset": late.seconds, "se": late.sd} for device, late in of.items()}
            for run, of in d.clocks.items()
        },
        "baseline": {
            run: {push: dict(found) for push, found in of.items()} for run, of in d.models.factory.campaign.rims.items()
        },
        "physical": d.ladder[-1].physical,
        "disturbance": d.unexplained.as_json() if d.unexplained else None,
        "calibration": {c.record.name: c.as_json() for c in d.calibration},
        "notes": list(d.notes),
        "seconds": d.seconds,
    }


def ranking(d: Diagnosis) -> list[dict[str, Any]]:
    """Every effect, the refitted first, as the round in which it did best saw it."""
    first = d.rounds[0]
    scores = {s.effect: s for r in (*d.rounds, first) for s in r.scores}
    candidates: dict[str, tuple[Candidate, Round]] = {}
    for r in (*d.rounds, *d.beside):
        for c in r.candidates:
            if c.effect not in candidates or c.effect in d.included:
                candidates[c.effect] = (c, r)
    order = sorted(
        scores,
        key=lambda e: (
            e not in d.effects,
            e not in candidates,
            -(candidates[e][0].support.large if e in candidates else scores[e].likelihood_ratio),
        ),
    )
    rivals = _rivals(first.scores)
    nobody: tuple[Candidate | None, Round] = (None, first)
    seen = {e: candidates.get(e, nobody) for e in order}
    return [_row(d, scores[e], *seen[e], rivals.get(e, [])) for e in order]


def groups(d: Diagnosis) -> list[dict[str, Any]]:
    """Effects that were refitted together, as they may show only so: `beside` which others, their parameters by full name, and
    the p and fall of −2 log likelihood of all of them."""
    return [
        {
            "effects": list(c.members),
            "beside": list(r.effects),
            "parameters": {n: {"estimate": float(v), "se": finite(e)} for n, v, e in zip(names, c.estimate, c.se, strict=True)},
            "p": c.p,
            "lr": c.likelihood_ratio,
            "found": c.effect == (r.winner.effect if r.winner else None),
        }
        for r in d.rounds
        for c in r.groups
        if (names := d.models.factory.parameters(c.effect))
    ]


def _row(d: Diagnosis, s: Score, c: Candidate | None, r: Round, rivals: list[dict[str, Any]]) -> dict[str, Any]:
    records = d.models.factory.records
    estimate, se = _estimate(d, s, c)
    parameters = {
        name.rpartition(".")[2]: {
            "estimate": float(v),
            "se": finite(e),
            "unit": records[name].unit.name,
            "smallest_interesting": records[name].smallest_interesting,
            "made_up_by": _made_up(d, s, change),
            **({"interval": list(d.intervals[name])} if name in d.intervals else {}),
        }
        for name, v, e, change in zip(s.names, estimate, se, s.imitated.T, strict=True)
    }
    before = r.heldout.rms if r.heldout.runs else float("nan")
    return {
        "effect": s.effect,
        "parameters": parameters,
        "probability": belief.large if (belief := d.beliefs.get(s.effect)) else None,
        "probability_there": belief.there if belief else None,
        "p": c.p if c else min(1.0, s.p * len(r.scores)),
        "power": s.power,
        "lr": c.likelihood_ratio if c else s.likelihood_ratio,
        "hidden_in_fit": s.collinearity,
        "heldout_before": finite(before),
        "heldout_after": finite(c.heldout.rms) if c and c.heldout and c.heldout.runs else None,
        "rivals": [{**rival, **_odds(c, rival["effect"], r)} for rival in rivals],
        "verdict": _row_verdict(d, s, c),
        "one_form_of": _cause(d, s.effect),
        "in_model": s.effect in d.included,
    }


def _made_up(d: Diagnosis, s: Score, change: np.ndarray) -> list[dict[str, Any]]:
    """Fitted values that would make up for δ of a parameter, and by what change (m,): those that would be furthest out."""
    records = {**d.models.factory.records, **d.models.likelihood(d.included).records}
    far = np.divide(abs(change), s.spread, out=np.zeros(len(change)), where=s.spread > 0)
    most = [i for i in np.argsort(-far, kind="stable")[:MAKERS] if far[i] > 0]
    return [{"name": n, "change": float(change[i]), "unit": records[n].unit.name} for i in most if (n := s.by[i])]


def _cause(d: Diagnosis, effect: str) -> str | None:
    """Of what an effect is one form among several; None where the effect is its own cause."""
    cause = d.models.factory.catalogue[effect].cause
    return None if cause == effect else cause.partition(":")[0]


def _estimate(d: Diagnosis, s: Score, c: Candidate | None) -> tuple[np.ndarray, np.ndarray]:
    """Of an effect's parameters, with standard errors: in the last model where it is in that, else in its own."""
    if s.effect in d.included:
        value, covariance = estimates(d.top, s.names)
        return value, np.sqrt(np.maximum(np.diag(covariance), 0))
    return (c.estimate, c.se) if c else (s.estimate, s.se)


def _rivals(scores: Sequence[Score]) -> dict[str, list[dict[str, Any]]]:
    """By effect, those whose signature is most like its own."""
    found = {}
    for i, row in enumerate(cosines(scores, scores)):
        most = [j for j in np.argsort(-row) if j != i and row[j] > ALIKE_AT_ALL][:RIVALS]
        found[scores[i].effect] = [{"effect": scores[j].effect, "cosine": round(float(row[j]), 4)} for j in most]
    return found


def _odds(c: Candidate | None, rival: str, r: Round) -> dict[str, float]:
    """Log odds (natural) of an effect against a rival that was refitted beside the same model, if one of them is missing."""
    other = next((o for o in r.candidates if o.effect == rival), None)
    return {"log_odds": round(c.support.large - other.support.large, 2)} if c and other else {}


def _surely_small(d: Diagnosis, s: Score, c: Candidate | None) -> bool:
    """Is an effect, with its standard errors, below the sizes of interest?"""
    value, se = _estimate(d, s, c)
    return bool(np.all(np.abs(value) + NORMAL * se < d.models.factory.deltas(s.names)))


def _row_verdict(d: Diagnosis, s: Score, c: Candidate | None) -> str:
    if any(s.effect in t for t in d.ties):
        return "tie"
    if s.effect in d.effects:
        return "small" if d.verdict == "small" else "missing"
    if s.effect in d.included:
        return "small" if _surely_small(d, s, c) else "cannot_see"
    if c and not c.matters and c.p < SIGNIFICANT:
        return "small"
    return "not needed" if s.power >= d.models.policy.power else "cannot_see"


def leftover_json(d: Diagnosis) -> dict[str, Any]:
    """Is anything structured left, and where."""
    if d.leftover is None:
        return {"p": None, "where": None}
    refitted = (d.proposal,) if d.proposal else d.leftover.candidates
    terms: list[Candidate | Score] = [*refitted, *d.leftover.scores]
    if not terms:
        return {"p": 1.0, "where": None}
    best = terms[0]
    p = best.p if refitted else min(1.0, best.p * len(d.leftover.scores))
    rms, run, channel = d.leftover.fit.evidence.worst
    out = {"p": p, "where": {"run": run, "channel": channel, "rms": rms}, "term": best.effect}
    if d.proposal:
        out["proposal"] = {"term": best.effect, "estimate": float(best.estimate[0]), "se": finite(best.se[0])}
    return out
