"""docs/your-own-law.md: its two files do what it says."""

from __future__ import annotations

import pytest

from tests.pages import its_test_passes, run

PAGE = "your-own-law.md"


def test_the_page_s_law_passes_the_page_s_test(tmp_path):
    its_test_passes(PAGE, tmp_path)


@pytest.mark.nightly
def test_the_fmu_has_it(tmp_path):
    its_test_passes(PAGE, tmp_path)
    slalom = ("-m", "wheelchair_fmu.cli.main", "simulate", "slalom", "--set", "tyre.law=brush")
    assert "out/slalom.csv" in run(tmp_path, *slalom)


def test_a_file_without_its_law_is_told(tmp_path):
    from wheelchair_fmu.errors import ModelError
    from wheelchair_fmu.model.lawful import laws

    with pytest.raises(ModelError, match=r'no law \'common\' in it; write LAW = Alternative\("common", ...\)'):
        laws("wheelchair_fmu.model.tyre", ["common"])
