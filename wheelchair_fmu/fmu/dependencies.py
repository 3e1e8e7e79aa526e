"""What depends on what, for ModelStructure: found in the structure of the equations, not by trying values."""

from __future__ import annotations

from collections.abc import Iterable

import casadi as cs
import numpy as np

from ..engine.kernel import algebraic
from ..model.wheelchair import Model
from .variables import Interface, Variable

Known = dict[str, list[tuple[Variable, str]]]  # per output: the variables it depends on, and how
KINDS = ("", "constant", "fixed", "tunable", "dependent")  # ever weaker promises


def outputs(face: Interface) -> Known:
    """Direct feedthrough: which inputs act on which outputs at once, also through algebraic states."""
    kind = np.maximum.reduce([_feedthrough(m, face) for m in face.models.values()])
    inputs = face.of("input")
    return {o.name: [(inputs[j], KINDS[kind[o.index, j]]) for j in np.nonzero(kind[o.index])[0]]
            for o in face.of("output")}  # fmt: skip


def initial(face: Interface) -> Known:
    """Which inputs and parameters the outputs at the start depend on."""
    on_p, on_w = (np.logical_or.reduce(parts) for parts in zip(*map(_at_start, face.models.values()), strict=True))
    if face.chooser:
        group = face.chooser.rpartition(".")[0] + "."  # what the chosen model reads, the choice acts on
        chosen = [v.index for v in face.of("parameter") if v.name.startswith(group)]
        on_p[:, face.by_name[face.chooser].index] |= on_p[:, chosen].any(axis=1)
    known = {}
    for o in face.of("output"):
        rows = [*(v for v in face.of("parameter") if on_p[o.index, v.index]),
                *(v for v in face.of("input") if on_w[o.index, v.index])]  # fmt: skip
        known[o.name] = [(v, "dependent") for v in rows]
    return known


def _pattern(m: Model, what: cs.SX, by: int) -> np.ndarray:
    """Which entries of `what` read which of x (0), w (1) or p (2)."""
    sparsity = cs.Function("f", [m.x, m.w, m.p], [what]).jac_sparsity(0, by)
    return np.array(cs.DM(sparsity, 1.0), dtype=bool)


def _reach(pattern: np.ndarray) -> np.ndarray:
    """Which unknowns follow from which rows of a solvable system with this pattern."""
    reach = pattern | np.eye(len(pattern), dtype=bool)
    for _ in range(len(pattern)):
        reach = reach @ reach
    return reach


def _algebraic_on(m: Model, direct: np.ndarray) -> np.ndarray:
    """What the algebraic states depend on, given what their rows do directly."""
    places = algebraic(m)
    return _reach(_pattern(m, m.f, 0)[np.ix_(places, places)]) @ direct


def _feedthrough(m: Model, face: Interface) -> np.ndarray:
    """Kind (place in KINDS) of each output's dependence on each input."""
    direct = cs.jacobian(m.y, m.w)
    entries = cs.vertcat(*direct.nonzeros()) if direct.nnz() else cs.SX(0, 1)
    moves = _any(_pattern(m, entries, 0)) | _any(_pattern(m, entries, 1))
    by_p = _pattern(m, entries, 2)
    tunable = np.array([not v.fixed for v in face.of("parameter")])
    kind = np.where(_pattern(m, m.y, 1), 4, 0)  # where there is no slope, as of a condition, it still switches
    for e, (i, j) in enumerate(_places(direct)):
        kind[i, j] = 4 if moves[e] else 3 if (by_p[e] & tunable).any() else 2 if by_p[e].any() else 1
        if entries[e].is_zero():
            kind[i, j] = 0  # the terms cancel, as a push does in the push needed
    places = algebraic(m)
    if places:
        kind[_pattern(m, m.y, 0)[:, places] @ _algebraic_on(m, _pattern(m, m.f, 1)[places])] = 4
    return kind


def _any(pattern: np.ndarray) -> np.ndarray:
    return pattern.any(axis=1)


def _places(matrix: cs.SX) -> Iterable[tuple[int, int]]:
    return zip(*matrix.sparsity().get_triplet(), strict=True)


def _at_start(m: Model) -> tuple[np.ndarray, np.ndarray]:
    """Dependence of each output at the start on parameters, and on inputs."""
    places = algebraic(m)
    f_x, y_x = _pattern(m, m.f, 0), _pattern(m, m.y, 0)
    found = []
    for by in (2, 1):
        x_on = _pattern(m, m.start, by)
        if places:
            rows = _pattern(m, m.f, by)[places] | (_pattern(m, m.mass, by)[places] if by == 2 else False)
            others = [i for i in range(m.x.numel()) if i not in places]
            x_on[places] |= _algebraic_on(m, rows | (f_x[np.ix_(places, others)] @ x_on[others]))
        found.append(_pattern(m, m.y, by) | (y_x @ x_on))
    return found[0], found[1]
