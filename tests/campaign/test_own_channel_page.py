"""docs/your-own-channel.md: its two files do what it says."""

from __future__ import annotations

import pytest

from tests.pages import its_test_passes, run

PAGE = "your-own-channel.md"


def test_the_page_s_channel_passes_the_page_s_test(tmp_path):
    its_test_passes(PAGE, tmp_path)


@pytest.mark.nightly
def test_the_fmu_has_it(tmp_path):
    its_test_passes(PAGE, tmp_path)
    assert "out/slalom.csv" in run(tmp_path, "-m", "wheelchair_fmu.cli.main", "simulate", "slalom")
    header = (tmp_path / "out" / "slalom.csv").read_text(encoding="utf-8").partition("\n")[0]
    assert "sensor.ground_speed [m/s]" in header
