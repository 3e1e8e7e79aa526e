"""One case: write the campaign, run the loop and its baselines on it, and keep what they said."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from wheelchair_fmu.campaign import Campaign, read
from wheelchair_fmu.inference.decision.bootstrap import bootstrap
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.explain.ranking import as_json
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.generic import library
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

from ..independent.campaigns import make
from ..independent.chair import Chair
from .baselines import baselines
from .cases import Case


def _chair(case: Case) -> dict[str, float]:
    """In what the other simulator's chair is not the usual one: casters that are not ideal have the front axle's load at their
    patches, and no two tyres have patches of one length."""
    chair = {} if case.casters == "ideal" else {"patch_load": 1.0}
    if "turn_slip" in case.hidden:
        chair["turn_length"] = Chair().turn_length * 2 ** np.random.default_rng([case.seed, 9]).uniform(-1, 1)
    return chair


def written(case: Case, folder: Path) -> Path:
    """A campaign with what a case hides, in this folder."""
    how = dict(noise=case.noise, manoeuvres=case.manoeuvres, channels=case.channels, seed=case.seed)
    return make(folder, case.hidden, chair=_chair(case), **how)


@contextmanager
def asked(case: Case) -> Iterator[tuple[Campaign, Variant]]:
    """The campaign of a case, and the chair that it is compared with."""
    catalogue = {name: effect for name, effect in bundled().items() if name not in case.left_out}
    with tempfile.TemporaryDirectory() as place:
        yield read(written(case, Path(place) / "campaign")), Variant(Choice(caster=case.casters), catalogue=catalogue)


def trial(case: Case, with_baselines: bool) -> dict[str, Any]:
    """What was hidden, and what the loop and its baselines said."""
    with asked(case) as (campaign, chair):
        began = time.process_time()
        found = diagnose(campaign, chair, library())
        said = as_json(found)
        seconds = time.process_time() - began
        resampled = bootstrap(found).estimates
        others = baselines(found.models) if with_baselines else {}
    rows = {row["effect"]: row for row in said["ranking"]}
    return {
        "case": case.name,
        "kind": case.kind,
        "effects": case.effects,
        "times": case.times,
        "noise": case.noise,
        "seed": case.seed,
        "true": {e: dict(v) for e, v in case.true.items()},
        "own": case.own,
        "verdict": said["verdict"],
        "found": said["effects"],
        "ties": said["ties"],
        "order": [row["effect"] for row in said["ranking"]],
        "ladder": said["ladder"],
        "leftover": said["leftover"],
        "notes": said["notes"],
        "rows": {e: rows[e] for e in case.effects if e in rows},
        "probabilities": {e: row["probability"] for e, row in rows.items()},
        "cpu": seconds,
        "seconds": said["seconds"],
        "baselines": others,
        "intervals": {"profile": dict(found.intervals), "bootstrap": {n: e[1:] for n, e in resampled.items()}},
    }
