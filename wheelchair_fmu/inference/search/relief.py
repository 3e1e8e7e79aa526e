"""Effects that would let a given value be what it was measured as, where calibration bends it as far as it may go."""

from __future__ import annotations

from collections.abc import Sequence

from ..estimation.calibration import DOUBTED, Calibrated
from .candidate import Candidate
from .rounds import Round

MOST = 3  # that are named


def reliefs(latest: Round, values: Sequence[Calibrated]) -> list[str]:
    """A sentence for each effect of the latest round with which no value is bent, the likeliest first."""
    strained = [v for v in values if v.beyond]
    able = (c for c in latest.candidates if c.matters and all(_relieved(v, c) for v in strained))
    return [_words(c, strained) for c in list(able)[:MOST]] if strained else []


def _relieved(v: Calibrated, c: Candidate) -> bool:
    return abs(c.fit.values[v.record.name] - v.prior) < DOUBTED * v.prior_sd


def _words(c: Candidate, strained: Sequence[Calibrated]) -> str:
    """ "with turn_slip chair.a comes out at 0.2561 m: ..." """
    told = " and ".join(
        f"{v.record.name} comes out at {c.fit.values[v.record.name]:.4g} {v.record.unit.name}" for v in strained
    )
    return f"with {c.effect} {told}: either that is missing, or what was given is wrong"
