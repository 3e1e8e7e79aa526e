"""Campaigns that several tests of the loop diagnose."""

from __future__ import annotations

from pathlib import Path

import pytest

from wheelchair_fmu.campaign import Campaign, read

ROOT = Path(__file__).parents[2]
MEASUREMENTS = ROOT.parent / "shared" / "measurements"


@pytest.fixture(scope="session")
def sample() -> Campaign:
    return read(ROOT / "examples" / "sample-campaign")


def measured(name: str) -> Campaign:
    """A campaign that is no part of the project; skips, visibly, where it is not there."""
    if not (MEASUREMENTS / name).is_dir():
        pytest.skip(f"{name} is not there: the measurements are no part of the project")
    return read(MEASUREMENTS / name)
