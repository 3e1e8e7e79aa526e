"""A diagnosis with all that can be found out: generic terms for what the catalogue lacks, and runs that could be made next."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from ..campaign import CHANNELS, Campaign
from ..handling.experiments import experiments
from ..inference.decision.diagnosis import Diagnosis
from ..inference.decision.final import final
from ..inference.decision.verdict import diagnose
from ..inference.explain.story import story
from ..model.generic import library
from ..model.variant import Variant
from ..report.content import content, noise_told
from ..report.page import page
from ..report.paper.case import checked
from ..report.paper.folder import supplement
from ..report.tale import story_of
from ..report.words import headline, in_full, particulars
from .lacking import missing

Story = dict[str, Any]


def searched(
    measured: Campaign, chair: Variant, fixed: Sequence[str], say: Callable[[str], None] = lambda words: None
) -> tuple[Diagnosis, Story]:
    """The diagnosis, and the story that `diagnose --json` writes."""
    found = diagnose(measured, chair, library(), progress=say, experiments=experiments(), fixed=fixed)
    terms = {p.name: p for e in library().values() for p in e.owned}
    with threadpool_limits(limits=1):  # as in diagnose: BLAS threads would spin for seconds
        return found, {**story(found), "missing": missing(found), "final": final(found, terms)}


def page_of(measured: Campaign, chair: Variant, told: Story, fixed: Sequence[str]) -> str:
    """The page that `wheelchair report` writes, as HTML."""
    chair = _with_proposal(chair, told)
    titles = {e.id: in_full(e.title) for e in chair.catalogue.values()}
    known = (*chair.parameters(), *(p for e in chair.catalogue.values() for p in e.owned))
    records = {p.name: replace(p, meaning=in_full(p.meaning)) for p in known}
    colour = noise_told(told, measured.noise)
    tale = story_of(told, titles, records, {c.name: c.unit for c in CHANNELS})
    return page(
        content(measured, chair, colour, told, fixed), headline(told, titles, records), particulars(told, records, titles), tale
    )


def supplement_of(
    measured: Campaign,
    chair: Variant,
    told: Story,
    fixed: Sequence[str],
    folder: Path,
    place: str,
    say: Callable[[str], None] = lambda words: None,
) -> tuple[Path, ...]:
    """The files that `wheelchair report --paper` writes into a folder; `place` is what messages call the diagnosis.

    Raises Failure for a diagnosis of other data, another chair or an earlier version, and OSError where nothing can be written.
    """
    told = json.loads(json.dumps(told))  # as it is read from a file
    return supplement(checked(measured, chair, told, fixed, place), folder, say)


def _with_proposal(chair: Variant, told: Mapping[str, Any]) -> Variant:
    """The chair whose catalogue also has the generic terms that the diagnosis used."""
    named = {name.split(".")[1] for m in told["models"] for name in m["values"] if name.startswith("effect.")}
    more = {e: effect for e, effect in library().items() if e in named and e not in chair.catalogue}
    return replace(chair, catalogue={**chair.catalogue, **more})
