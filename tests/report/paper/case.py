"""The sample campaign's diagnosis, as `tests.kit` keeps it, and changes of it."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from tests.kit import SAMPLE_DIAGNOSIS as TOLD
from wheelchair_fmu.campaign import Campaign, read, windows
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.report.paper.case import Case, checked

SAMPLE = Path(__file__).parents[3] / "examples" / "sample-campaign"
DRAG = "rolling_resistance_asymmetry"
SIZE = f"effect.{DRAG}.D"


@cache
def sample() -> Campaign:
    return windows(read(SAMPLE))


def told(**more: Any) -> dict[str, Any]:
    """The diagnosis with other values of some keys, of its own to be changed."""
    return {**json.loads(TOLD.read_text(encoding="utf-8")), **more}


def case_of(diagnosis: dict[str, Any] | None = None, campaign: Campaign | None = None) -> Case:
    return checked(campaign or sample(), Variant(), diagnosis or told(), (), "d.json")
