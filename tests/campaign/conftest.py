"""Small campaigns, written on the fly."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from .small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows


@pytest.fixture
def campaign(tmp_path: Path) -> Callable[..., Path]:
    """Writes a sound campaign; any part may be replaced, `files` by name."""

    def write(
        toml: str | None = None, *, head: str = HEAD, noise: str = NOISE, runs: str = RUNS, files: dict | None = None
    ) -> Path:
        (tmp_path / "campaign.toml").write_text(toml if toml is not None else head + noise + runs, encoding="utf-8")
        contents = {"a.csv": csv_text(SI, rows(motion())), "b.csv": csv_text(SI, rows(motion(seed=1)))} | (files or {})
        for name, content in contents.items():
            (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return tmp_path

    return write
