"""MATLAB files: version 5 by SciPy, version 7.3 by h5py."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._mat_columns import as_table
from ._mat_tree import tree_5, tree_73
from ._record import DATES, RATE, Format, Option, Read
from ._support import by_library, one

VARIABLE = Option(
    "variable", "text", "", "all variables", "the variable, or structure such as rec.left, that holds the recording"
)
_HDF5 = b"\x89HDF\r\n\x1a\n"


def _recognises(path: Path, head: bytes) -> bool:
    return head[:10] in (b"MATLAB 5.0", b"MATLAB 7.3")


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    with path.open("rb") as content:
        newer = _HDF5 in content.read(2048)
    library, tree = ("h5py", tree_73) if newer else ("scipy.io", tree_5)

    def read(module: Any) -> Read:
        variables = tree(module, path)
        if not variables:
            return one(file, "the file holds no variables", "save it again")
        return as_table(file, variables, options)

    return by_library(path, file, library, read)


FORMAT = Format(
    "mat",
    "MATLAB",
    (".mat",),
    "Vectors of one length become columns named as the path to them, such as rec.left.omega; a matrix with `names` beside it "
    "becomes rec.data.NAME, and `units` beside it gives their units.",
    (VARIABLE, DATES, RATE),
    "h5py",
    _recognises,
    _read,
)
