"""Output files: written beside their place, then renamed, so that nothing there is replaced by half a result."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np


@contextmanager
def written(path: Path) -> Iterator[Path]:
    """A path to write to, with the same ending; what is there becomes `path` if all goes well.

    Raises OSError where the folder cannot be made or written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{os.getpid()}-{path.name}")
    try:
        yield beside
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def write_table(path: Path, columns: Mapping[str, np.ndarray]) -> None:
    """Columns (n,) by header as CSV, with ten digits."""
    with written(path) as beside, beside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows([f"{value:.10g}" for value in row] for row in zip(*columns.values(), strict=True))


def write_json(path: Path, content: Any) -> None:
    """As `print_json`, into a file."""
    with written(path) as beside:
        beside.write_text(_json(content) + "\n", encoding="utf-8")


def print_json(content: Any) -> None:
    """To stdout, with two spaces and letters as they are."""
    print(_json(content))


def _json(content: Any) -> str:
    return json.dumps(content, indent=2, ensure_ascii=False)
