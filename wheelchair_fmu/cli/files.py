"""Tables and JSON, into a file or to stdout."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from ..writing import written
from .terminal import printable_json


class TableKind(StrEnum):
    """What a table of series is written as."""

    csv = "csv"
    parquet = "parquet"


Kind = Annotated[TableKind, typer.Option("--table", help="What a table of series is written as.")]
# How `--output` was spelt in some commands: still understood, but not shown.
Out = Annotated[Path | None, typer.Option("--out", metavar="DIR", hidden=True)]


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
    return printable_json(json.dumps(content, indent=2, ensure_ascii=False))
