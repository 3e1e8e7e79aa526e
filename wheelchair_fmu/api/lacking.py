"""What a model lacks, as a free function of one variable after another: for figures, the page and JSON."""

from __future__ import annotations

from typing import Any

from ..inference.decision.diagnosis import Diagnosis
from ..inference.estimation.statistics import finite
from ..inference.explain.profile import profiles as estimate_profiles
from ..model.generic import VARIABLES, profiles, terms

FORCES = {"force": ("force along the chair", "N"), "moment": ("moment about the vertical", "N.m")}  # as generic terms have them


def missing(d: Diagnosis) -> dict[str, Any] | None:
    """The key `missing` of a diagnosis that proposes a term, or whose model lacks a force that something orders: the quantity
    in words, its unit, and a panel for each variable {"variable", "unit", "knots", "estimate", "se"}, None where the data say
    nothing."""
    if d.proposal is None:
        return _ordered(d)
    term = terms()[d.proposal.effect]
    found = estimate_profiles(d.models, d.rounds[0].fit, d.rounds[0].effects, profiles(term))
    panels = [
        {
            "variable": words,
            "unit": unit,
            "knots": list(knots),
            "estimate": [finite(v) for v in p.estimate],
            "se": [finite(v) for v in p.se],
        }
        for p, (words, unit, _, knots) in zip(found, VARIABLES.values(), strict=True)
    ]
    return {"words": term.noun.split(" ", 1)[1], "unit": term.unit.name, "panels": panels, "ordered": False}


def _ordered(d: Diagnosis) -> dict[str, Any] | None:
    """The same of forces that nobody recorded, where the verdict is "outside": the one that is ordered best."""
    orders = [o for o in d.unexplained.ordered if o.panel] if d.unexplained and d.verdict == "outside" else []
    if not orders:
        return None
    words, unit = FORCES[orders[0].of]
    panels = [o.panel.as_json() for o in orders if o.of == orders[0].of and o.panel]
    return {"words": words, "unit": unit, "panels": panels, "ordered": True}
