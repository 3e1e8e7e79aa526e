"""The content of a MATLAB file as nested dicts and lists with NumPy arrays and texts as leaves."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Opaque:
    """What only MATLAB can read: a function handle, an object, a table."""

    kind: str


def tree_5(library: Any, path: Path) -> dict[str, Any]:
    """A file up to version 7, by scipy.io."""
    found = library.loadmat(str(path), simplify_cells=True)
    return {name: _plain_5(value) for name, value in found.items() if not name.startswith("__") and name}


def _plain_5(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _plain_5(child) for name, child in value.items()}
    kind = type(value).__name__
    if kind in ("MatlabFunction", "MatlabOpaque", "MatlabObject"):
        return Opaque("a function handle" if kind == "MatlabFunction" else "an object")
    if isinstance(value, np.ndarray) and value.dtype.names:
        return Opaque("an object")
    if isinstance(value, list) or (isinstance(value, np.ndarray) and value.dtype == object):
        return (
            [_plain_5(child) for child in np.asarray(value, dtype=object).ravel()]
            if not isinstance(value, list)
            else [_plain_5(child) for child in value]
        )
    if isinstance(value, np.ndarray) and value.dtype.kind == "U":
        return [str(text).strip() for text in value.ravel()]
    return value.strip() if isinstance(value, str) else np.asarray(value)


def tree_73(library: Any, path: Path) -> dict[str, Any]:
    """A file of version 7.3, which is HDF5, by h5py."""
    with library.File(str(path), "r") as file:
        return {name: _plain_73(library, file, child) for name, child in file.items() if not name.startswith("#")}


def _plain_73(library: Any, file: Any, node: Any) -> Any:
    kind = bytes(node.attrs.get("MATLAB_class", b"")).decode(errors="replace")
    if isinstance(node, library.Group):
        if kind not in ("", "struct"):
            return Opaque("a function handle" if kind == "function_handle" else "an object")
        return {name: _plain_73(library, file, child) for name, child in node.items()}
    if "MATLAB_object_decode" in node.attrs or kind in ("function_handle", "table", "string", "datetime"):
        return Opaque("a function handle" if kind == "function_handle" else "an object")
    if node.attrs.get("MATLAB_empty", 0):
        return np.empty(0)
    content = node[()]
    if node.dtype == library.ref_dtype:  # a cell, or a field of an array of structures
        return [_plain_73(library, file, file[place]) for place in np.ravel(content.T)]
    if kind == "char":
        return "".join(chr(int(letter)) for letter in np.ravel(content.T)).strip()
    return np.squeeze(np.asarray(content).T)
