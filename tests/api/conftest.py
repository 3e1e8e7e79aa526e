"""The sample campaign, compared and diagnosed once."""

from __future__ import annotations

from pathlib import Path

import pytest

import wheelchair_fmu as wc

SAMPLE = Path(__file__).parents[2] / "examples" / "sample-campaign"


@pytest.fixture(scope="session")
def campaign() -> wc.Campaign:
    return wc.read(SAMPLE)


@pytest.fixture(scope="session")
def found(campaign) -> wc.Diagnosis:
    return wc.diagnose(campaign)
