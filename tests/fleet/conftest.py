"""A fleet of three chairs: two with more drag of the air than the model has, one whose file is wrong in three places."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from benchmarks.independent.campaigns import make
from benchmarks.independent.hidden import usual
from benchmarks.independent.manoeuvres import STRAIGHT

SHORT = tuple(replace(run, duration=6.0) for run in STRAIGHT)


@pytest.fixture(scope="session")
def garage(tmp_path_factory) -> Path:
    """The folder of their campaigns."""
    folder = tmp_path_factory.mktemp("garage")
    for name, seed in (("a", 1), ("c", 2)):
        make(folder / name, {"aerodynamic_drag": usual("aerodynamic_drag", 4.0)}, manoeuvres=SHORT, seed=seed)
    shutil.copytree(folder / "a", folder / "b")
    text = (folder / "b" / "campaign.toml").read_text()
    (folder / "b" / "campaign.toml").write_text(text.replace('role = "fit"', 'role = "spare"'))
    return folder
