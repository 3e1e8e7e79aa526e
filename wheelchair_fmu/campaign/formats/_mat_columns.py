"""Columns of one length out of what a MATLAB file holds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pandas as pd

from ...timestamps import is_stamp, named_time
from ...units import suffixed
from ._mat_tree import Opaque
from ._record import Read
from ._support import framed, one, stated

DEEPEST = 3  # names of a path
_NAMES = ("names", "labels", "channels", "columns", "header", "headers", "varnames")
_UNITS = ("units", "unit")
_FEWEST = 2  # values of a column


class _TooDeep(ValueError):
    """A path with more names than a column's may have."""


def as_table(file: str, tree: Mapping[str, Any], options: Mapping[str, Any]) -> Read:
    """The vectors of the most common length, that of the time where there is one."""
    asked = options.get("variable")
    if isinstance(asked, str):
        chosen = _at(tree, asked)
        if chosen is None:
            return one(file, f"there is no variable {asked!r}", f"the file has {', '.join(_paths(tree))}")
        tree = chosen if isinstance(chosen, dict) else {asked.rpartition(".")[2]: chosen}
    opaque = [f"{path} is {leaf.kind}" for path, leaf in _leaves(tree, "", 99) if isinstance(leaf, Opaque)]
    try:
        columns = list(_columns(tree, ""))
    except _TooDeep as deep:
        fact = f"structures in structures in structures, deeper than {DEEPEST} names: {deep}"
        return one(file, fact, 'write variable = "..." in the run with a path that leads nearer')
    columns = [(path, values, unit) for path, values, unit in columns if len(values) >= _FEWEST]
    if not columns:
        found = f"the file holds no vectors of numbers, but {', '.join(opaque or _paths(tree) or ['nothing'])}"
        return one(file, found, "save vectors or a structure of vectors, as struct2table and table2array give")
    times = [len(values) for path, values, _ in columns if _is_time(path)]
    if len(set(times)) > 1:
        paths = ", ".join(f"{path} ({len(values)})" for path, values, _ in columns if _is_time(path))
        return one(file, f"several recordings of different length: {paths}", 'write variable = "..." with one of them')
    length = times[0] if times else Counter(len(values) for _, values, _ in columns).most_common(1)[0][0]
    kept = [column for column in columns if len(column[1]) == length]
    left = [
        f"{path} has {len(values)} values, not {length}, and is left out"
        for path, values, _ in columns
        if len(values) != length
    ]
    frame = pd.concat([pd.Series(values, name=path) for path, values, _ in kept], axis=1)
    units = [stated(path, unit) for path, _, unit in kept]
    return framed(
        file, frame, options, units, [*left, *(f"{what}, which only MATLAB reads, and is left out" for what in opaque)]
    )


def _at(tree: Mapping[str, Any], path: str) -> Any:
    node: Any = tree
    for name in path.split("."):
        node = node.get(name) if isinstance(node, Mapping) else None
    return node


def _leaves(node: Any, path: str, deepest: int) -> Iterator[tuple[str, Any]]:
    if isinstance(node, Mapping) and deepest:
        for name, child in node.items():
            yield from _leaves(child, f"{path}.{name}" if path else name, deepest - 1)
    else:
        yield path, node


def _paths(tree: Mapping[str, Any]) -> list[str]:
    return [path for path, _ in _leaves(tree, "", DEEPEST)][:20]


def _is_time(path: str) -> bool:
    return named_time(suffixed(path.rpartition(".")[2])[0])


def _columns(node: Mapping[str, Any], path: str) -> Iterator[tuple[str, Any, str | None]]:
    """Path, values and unit (from a sibling) of all columns below a structure."""
    names = next((_texts(node[key]) for key in node if key.casefold() in _NAMES and _texts(node[key])), [])
    given = next((node[key] for key in node if key.casefold() in _UNITS), None)
    for name, child in node.items():
        here = f"{path}.{name}" if path else name
        child = _structure(child)
        if isinstance(child, Mapping):
            if here.count(".") >= DEEPEST - 1 and any(isinstance(_structure(c), Mapping) for c in child.values()):
                raise _TooDeep(", ".join([p for p, _ in _leaves(child, here, 9)][:6]))
            yield from _columns(child, here)
        elif isinstance(child, np.ndarray) and child.dtype.kind in "fiub":
            yield from _of_array(here, child, names, given)
        elif isinstance(child, list) and len(child) >= _FEWEST and all(isinstance(c, str) and is_stamp(c) for c in child):
            yield here, np.array(child, dtype=object), None


def _structure(child: Any) -> Any:
    """An array of structures that hold one number each is a structure of vectors; of others, each counts as one."""
    if not (isinstance(child, list) and child and all(isinstance(c, Mapping) for c in child)):
        return child
    if all(np.size(value) == 1 for c in child for value in c.values() if not isinstance(value, str | Opaque | Mapping | list)):
        keys = [k for k in child[0] if all(isinstance(c.get(k), np.ndarray) and np.size(c[k]) == 1 for c in child)]
        return {k: np.array([float(np.ravel(c[k])[0]) for c in child]) for k in keys}
    return {str(i): c for i, c in enumerate(child, 1)}


def _texts(value: Any) -> list[str]:
    if isinstance(value, str):
        return [value]
    return [str(v) for v in value] if isinstance(value, list) and all(isinstance(v, str) for v in value) else []


def _of_array(path: str, array: np.ndarray, names: list[str], given: Any) -> Iterator[tuple[str, Any, str | None]]:
    """A vector, or the columns of a matrix under the names that stand beside it."""
    array = np.squeeze(array)
    own = path.rpartition(".")[2]
    single = given.get(own) if isinstance(given, Mapping) else None
    if array.ndim == 1:
        yield path, array.astype(float), single if isinstance(single, str) else None
    elif array.ndim == 2:
        if array.shape[1] > array.shape[0] or (len(names) == array.shape[0] != array.shape[1]):
            array = array.T
        units = _texts(given)
        for k in range(array.shape[1]):
            name = names[k] if len(names) == array.shape[1] else str(k + 1)
            yield f"{path}.{name}", array[:, k].astype(float), units[k] if len(units) == array.shape[1] else None
