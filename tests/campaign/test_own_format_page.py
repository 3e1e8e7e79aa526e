"""docs/your-own-format.md: its program reads what it says."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.campaign.formats import _registry, formats

PAGE = Path(__file__).parents[2] / "docs" / "your-own-format.md"
CAMPAIGN = """
[campaign]
axes = "SAE-J670"
[noise]
F_rl = 0.4
F_rr = 0.4
yaw_rate = 0.01
[[run]]
files = {rims = "a.rim", gyro = "a.csv"}
manoeuvre = "strokes"
role = "fit"
[[recording]]
device = "rims"
[[recording]]
device = "gyro"
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    own = tmp_path / "config"
    own.mkdir()
    (program,) = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    (own / "rimlog.py").write_text(program, encoding="utf-8")
    monkeypatch.setattr(_registry, "user_folder", lambda: own)
    formats.cache_clear()
    yield tmp_path
    formats.cache_clear()


def test_the_program_of_the_page_reads_its_files_and_says_what_is_wrong(folder):
    t = np.arange(0, 4000, 10.0)
    forces = 20 * np.sin(t / 500) ** 2
    content = b"RIMLOG01" + np.column_stack([t, forces, -forces]).astype("<f4").tobytes()
    (folder / "a.rim").write_bytes(content)
    rows = "\n".join(f"{a / 1000:.2f},{0.1 * np.sin(a / 700):.6f}" for a in t)
    (folder / "a.csv").write_text(f"time [s],yaw_rate [rad/s]\n{rows}\n", encoding="utf-8")
    (folder / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    (run,) = read(folder).runs
    assert np.allclose(run.inputs["push.F_rl"], forces, atol=1e-5) and np.allclose(run.inputs["push.F_rr"], -forces, atol=1e-5)
    (folder / "a.rim").write_bytes(content[:-1])
    assert any("4799 bytes are no whole samples of 12; copy it from the logger again" in str(f) for f in check(folder))
