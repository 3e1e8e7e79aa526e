"""The importers that are not Python's FMPy, each in the environment that `make importers` sets up."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.importers.__main__ import OTHERS, REFERENCE, TWO, coupled, drive, plain_host, reference

pytestmark = pytest.mark.nightly
needs_others = pytest.mark.skipif(not OTHERS, reason="no $IMPORTERS_PYTHON: `make importers` sets it up")


@needs_others
@pytest.mark.parametrize("run", [REFERENCE, TWO])
@pytest.mark.parametrize(("script", "fmi"), [("libcosimpy", "2"), ("cofmupy", "2"), ("cofmupy", "3")])
def test_others_get_the_reference(script, fmi, run, native, native3, tmp_path: Path):
    archive = (native if fmi == "2" else native3).path
    expected = reference(archive, tmp_path)
    result = drive(OTHERS, script, archive, tmp_path, fmi, "CoSimulation", run, expected if run == REFERENCE else coupled())
    assert result.good, result.verdict


@pytest.mark.parametrize("fmi", ["2", "3"])
def test_a_host_in_c_gets_what_the_engine_gives(fmi, native, native3, tmp_path: Path):
    assert plain_host((native if fmi == "2" else native3).path, fmi, tmp_path).good
