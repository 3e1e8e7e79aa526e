"""Columns of a table, without `pa.array`: that brings pandas along, which takes as long to import as a thousand chairs do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa


def column(values: Sequence[Any] | np.ndarray, kind: pa.DataType) -> pa.Array:
    """Texts, or numbers of 64 bits; None where there is none."""
    absent = np.array([value is None for value in values], bool)
    valid = pa.py_buffer(np.packbits(~absent, bitorder="little")) if absent.any() else None
    if kind == pa.string():
        texts = [b"" if value is None else str(value).encode() for value in values]
        offsets = np.cumsum([0, *map(len, texts)], dtype=np.int32)
        buffers = [valid, pa.py_buffer(offsets), pa.py_buffer(b"".join(texts))]
    else:
        numbers = np.where(absent, 0, np.asarray(values, object if absent.any() else None))
        buffers = [valid, pa.py_buffer(np.ascontiguousarray(numbers, "int64" if kind == pa.int64() else float))]
    return pa.Array.from_buffers(kind, len(values), buffers)


def woven(columns: Sequence[Any]) -> Any:
    """The first of each column, the second of each, and so on."""
    if all(isinstance(column, np.ndarray) for column in columns):
        return np.stack(columns, axis=1).ravel()
    return [value for row in zip(*columns, strict=True) for value in row]
