"""Campaigns that several tests of the loop diagnose."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from wheelchair_fmu.campaign import Campaign, read
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant

ROOT = Path(__file__).parents[2]
MEASUREMENTS = ROOT.parent / "shared" / "measurements"


@pytest.fixture(scope="session")
def sample() -> Campaign:
    return read(ROOT / "examples" / "sample-campaign")


def chairs(*effects: str) -> list[Any]:
    """For parameters of tests: a chair whose catalogue has these effects alone, and at night one with the whole catalogue, of
    which a search takes several times as long."""
    few = Variant(catalogue={effect: bundled()[effect] for effect in effects})
    whole = pytest.param(Variant(), id="whole catalogue", marks=pytest.mark.nightly)
    return [pytest.param(few, id="few effects"), whole]


def among(*effects: str):
    """`chairs`, for tests of `chair`."""
    return pytest.mark.parametrize("chair", chairs(*effects))


def measured(name: str) -> Campaign:
    """A campaign that is no part of the project; skips, visibly, where it is not there."""
    if not (MEASUREMENTS / name).is_dir():
        pytest.skip(f"{name} is not there: the measurements are no part of the project")
    return read(MEASUREMENTS / name)
