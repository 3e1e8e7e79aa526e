"""docs/python.md does what it shows."""

from __future__ import annotations

import doctest
import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "python.md"


@pytest.mark.nightly
def test_the_page_does_what_it_shows(found, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # The page reads another copy of the same campaign, and asks again for what made `found`.
    monkeypatch.setattr("wheelchair_fmu.api.diagnoses.searched", lambda *_: (found._found, found._told))
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    flags = doctest.NORMALIZE_WHITESPACE
    test = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, PAGE.name, str(PAGE), 0)
    said: list[str] = []
    done = doctest.DocTestRunner(optionflags=flags).run(test, out=said.append)
    assert done.attempted > 30 and not done.failed, "".join(said)
