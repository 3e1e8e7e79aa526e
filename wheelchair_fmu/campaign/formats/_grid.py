"""A sheet of a spreadsheet, cells of any kind, as a table."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ...dialect import GAPS, GROUPED, columns_of_numbers, find, is_data, same_unit, told_apart
from ...units import split
from ._record import DATES, RATE, Option, Read
from ._support import EMPTY, framed, one, stated

SHEET = Option("sheet", "text", "", "the only sheet with numbers", "the sheet to read")
OPTIONS = (SHEET, DATES, RATE)
Merged = Callable[[Path, str], list[tuple[int, int]]]
_FEWEST = 3  # rows of numbers: less is a note on a sheet


def read_sheets(path: Path, file: str, options: Mapping[str, Any], engine: str, merged: Merged) -> Read:
    """The sheet that is asked for, or the only one that has numbers. `merged` gives the rows that merged cells span."""
    with pd.ExcelFile(path, engine=engine) as book:
        names = [str(name) for name in book.sheet_names]
        asked = options.get("sheet")
        if asked is not None and asked not in names:
            return one(file, f"there is no sheet {asked!r}", f"the sheets are {_listed(names)}")
        grids = pd.read_excel(book, sheet_name=[asked] if asked else names, header=None, dtype=object)
    filled = [name for name, grid in grids.items() if asked or _has_numbers(grid)]
    if not filled:
        return one(file, f"no sheet has rows of numbers, of {_listed(names)}", EMPTY)
    if len(filled) > 1:
        return one(file, f"the sheets {_listed(filled)} have numbers", f'write sheet = "{filled[0]}" or another one in the run')
    notes = [f"sheet {filled[0]!r}, the only one with numbers"] if len(names) > 1 and not asked else []
    return _table(file, grids[filled[0]], options, notes, merged(path, filled[0]))


def _listed(names: Sequence[str]) -> str:
    return ", ".join(map(repr, names))


def _texts(grid: pd.DataFrame, rows: slice) -> list[list[str]]:
    return [[_text(cell) for cell in row] for row in grid.iloc[rows].itertuples(index=False)]


def _text(cell: Any) -> str:
    if cell is None or cell is pd.NaT or (isinstance(cell, float) and np.isnan(cell)):
        return ""
    if isinstance(cell, datetime):
        return cell.isoformat(sep=" ")
    return str(cell).strip()


def _has_numbers(grid: pd.DataFrame) -> bool:
    rows = _texts(grid, slice(max(0, len(grid) // 2 - 20), len(grid) // 2 + 20))
    numeric = columns_of_numbers(rows)
    return bool(numeric) and sum(is_data(row, numeric) for row in rows) >= _FEWEST


def _table(file: str, grid: pd.DataFrame, options: Mapping[str, Any], notes: list[str], merged: list[tuple[int, int]]) -> Read:
    numeric = columns_of_numbers(_texts(grid, slice(len(grid) // 2, len(grid) // 2 + 60)))
    above: list[list[str]] = []
    for row in _texts(grid, slice(None)) if numeric else ():
        if is_data(row, numeric):
            break
        above.append(row)
    else:
        return one(file, "the sheet has no rows of numbers", EMPTY)
    layout = find(above, len(above), max(numeric) + 1)
    if layout.header is None:
        fact = f"row {len(above) + 1} of the sheet already holds numbers: there is no header above it"
        return one(file, fact, "write a first row that names the columns, such as time [s]", len(above) + 1)
    touched = next((first for first, last in merged if last >= layout.header), None)
    if touched is not None:
        return one(file, "merged cells in the header or among the rows", "unmerge them in the spreadsheet", touched + 1)
    headers = list(told_apart(above[layout.header], above[layout.header - 1] if layout.header else ()))
    notes += [GROUPED] if headers != above[layout.header] else []
    places = [i for i, header in enumerate(headers) if header or any(map(_text, grid.iloc[layout.first :, i]))]
    headers = [headers[i] for i in places]
    body = grid.iloc[layout.first :, places].reset_index(drop=True)
    body = body[body.map(_text).ne("").any(axis=1)].reset_index(drop=True)
    body.columns = pd.RangeIndex(len(places))
    row = above[layout.units] if layout.units is not None else []
    units = [stated(h, row[i] if row and row[i] != "-" else None) for h, i in zip(headers, places, strict=True)]
    for header, unit in zip(headers, units, strict=True):
        own = split(header)[1]
        if own is not None and unit is not None and not same_unit(own, unit):
            fact = f"the header {header!r} says [{own}], the row of units below it says {unit!r}"
            return one(file, fact, "correct one of them", (layout.units or 0) + 1)
    notes += [f"{layout.header} rows before the header skipped"] if layout.header else []
    notes += ["a row of units below the header"] if layout.units is not None else []
    frame = pd.concat([_numbers(body[i]).rename(header) for i, header in enumerate(headers)], axis=1)
    return framed(file, frame, options, units, notes)


def _numbers(column: pd.Series) -> pd.Series:
    """Numbers where all that is not empty is one; else the cells as they are."""
    plain = column.map(lambda cell: np.nan if isinstance(cell, str) and cell.strip() in GAPS else cell)
    if all(isinstance(cell, int | float) or cell is None for cell in plain):
        return plain.astype(float)
    return plain
