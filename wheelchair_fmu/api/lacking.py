"""What a model lacks, as a free function of one variable after another: for figures, the page and JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..inference.decision.diagnosis import Diagnosis
from ..inference.explain.profile import profiles as estimate_profiles
from ..inference.residual.panel import Panel
from ..model.generic import VARIABLES, Term, profiles, terms

FORCES = {"force": "F_x", "moment": "M_z"}  # to what generic terms add that are such a force


def missing(d: Diagnosis) -> dict[str, Any] | None:
    """The key `missing` of a diagnosis that proposes a term, or whose model lacks a force that something orders: the quantity
    in words, its unit, whether it is `ordered`, and a panel for each variable {"variable", "unit", "knots", "estimate", "se"},
    None where the data say nothing."""
    if d.proposal is None:
        return _ordered(d)
    term = terms()[d.proposal.effect]
    found = estimate_profiles(d.models, d.rounds[0].fit, d.rounds[0].effects, profiles(term))
    panels = [
        Panel(words, unit, np.array(knots), np.array(p.estimate), np.array(p.se))
        for p, (words, unit, _, knots) in zip(found, VARIABLES.values(), strict=True)
    ]
    return _told(term, panels, ordered=False)


def _ordered(d: Diagnosis) -> dict[str, Any] | None:
    """The same of forces that nobody recorded, where the verdict is "outside": the one that is ordered best."""
    orders = [o for o in d.unexplained.ordered if o.panel] if d.unexplained and d.verdict == "outside" else []
    if not orders:
        return None
    of = orders[0].of
    term = next(t for t in terms().values() if t.to == FORCES[of])
    return _told(term, [o.panel for o in orders if o.of == of and o.panel], ordered=True)


def _told(term: Term, panels: Sequence[Panel], *, ordered: bool) -> dict[str, Any]:
    what = {"words": term.noun.split(" ", 1)[1], "unit": term.unit.name}
    return {**what, "panels": [panel.as_json() for panel in panels], "ordered": ordered}
