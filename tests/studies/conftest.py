"""One FMU for all, built once and kept where commands keep it too."""

from __future__ import annotations

import pytest

from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies import Fmu, fmu_of


@pytest.fixture(scope="module")
def fmu():
    with Fmu(fmu_of(Variant())) as driven:
        yield driven
