"""What a model lacks, as a free function of one variable after another: for figures, the page and JSON."""

from __future__ import annotations

from typing import Any

from ..inference.decision.verdict import Diagnosis
from ..inference.estimation.statistics import finite
from ..inference.explain.profile import profiles as estimate_profiles
from ..model.generic import VARIABLES, profiles, terms


def missing(d: Diagnosis) -> dict[str, Any] | None:
    """The key `missing` of a diagnosis that proposes a term: the quantity in words, its unit, and a panel for each variable
    {"variable", "unit", "knots", "estimate", "se"}, None where the data say nothing."""
    if d.proposal is None:
        return None
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
    return {"words": term.noun.split(" ", 1)[1], "unit": term.unit.name, "panels": panels}
