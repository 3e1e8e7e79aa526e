"""docs/campaign.md says what the records say, and its examples are campaigns that can be read."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

from wheelchair_fmu.campaign.checks.document import DOCUMENT_CHECKS
from wheelchair_fmu.campaign.document import load
from wheelchair_fmu.campaign.reference import page
from wheelchair_fmu.campaign.schema import TABLES, fits

DOC = Path(__file__).parents[2] / "docs" / "campaign.md"


def test_the_page_is_as_the_records_are():
    assert DOC.read_text(encoding="utf-8") == page(), "write it again by `make docs`"


def test_examples_in_the_page_have_no_faults_of_their_own(tmp_path):
    for text in re.findall(r"```toml\n(.*?)```", page(), re.DOTALL):
        (tmp_path / "campaign.toml").write_text(text, encoding="utf-8")
        doc, faults = load(tmp_path)
        assert doc is not None, faults
        found = [str(f) for judge in DOCUMENT_CHECKS for f in judge(doc, None) if f.severity == "error"]
        assert all("no such file" in f or "there are no runs" in f for f in found), found


def test_examples_of_keys_are_of_their_kind():
    for key in (k for t in TABLES for k in t.keys if k.example):
        values = tomllib.loads(key.example)
        assert key.name in str(values), key
        if key.name in values:
            assert fits(values[key.name], key.kind), key
