"""What depends on what, for ModelStructure: found in the structure of the equations, not by trying values."""

from __future__ import annotations

from collections.abc import Iterable

import casadi as cs
import numpy as np

from ..engine.kernel import algebraic, crossings, rate
from ..model.wheelchair import Model
from .variables import Interface, Variable

Known = dict[str, list[tuple[Variable, str]]]  # per unknown: the variables it depends on, and how
KINDS = ("", "constant", "fixed", "tunable", "dependent")  # ever weaker promises


def continuous(face: Interface) -> Known:
    """Which inputs and continuous states act on what at once, also through algebraic states."""
    models = face.models.values()
    by_x, by_w = (np.maximum.reduce([_kinds(m, face, by) for m in models]) for by in (0, 1))
    knowns = [*((place, v, by_x) for place, v in face.states.items()), *((v.index, v, by_w) for v in face.of("input"))]
    return {
        u.name: [(v, KINDS[kind[row, place]]) for place, v, kind in knowns if kind[row, place]] for row, u in _unknowns(face)
    }


def initial(face: Interface) -> Known:
    """Which inputs and parameters outputs and derivatives at the start depend on."""
    on_p, on_w = (np.logical_or.reduce(parts) for parts in zip(*map(_at_start, face.models.values()), strict=True))
    if face.chooser:
        group = face.chooser.rpartition(".")[0] + "."  # what the chosen model reads, the choice acts on
        chosen = [v.index for v in face.of("parameter") if v.name.startswith(group)]
        on_p[:, face.by_name[face.chooser].index] |= on_p[:, chosen].any(axis=1)
    return {
        u.name: [
            (v, "dependent") for on, kind in ((on_p, "parameter"), (on_w, "input")) for v in face.of(kind) if on[row, v.index]
        ]
        for row, u in _unknowns(face)
    }


def _expressions(m: Model) -> cs.SX:
    """Outputs, rates and crossings, one below the other."""
    return cs.vertcat(m.y, rate(m), crossings(m))


def _unknowns(face: Interface) -> list[tuple[int, Variable]]:
    """Outputs, derivatives and event indicators, by their row in `_expressions`."""
    m = face.model
    first = {"output": 0, "derivative": m.y.numel(), "indicator": m.y.numel() + m.x.numel()}
    return [(first[kind] + v.index, v) for kind in first for v in face.of(kind)]


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


def _kinds(m: Model, face: Interface, by: int) -> np.ndarray:
    """Kind (place in KINDS) of each expression's dependence on each of x (by = 0) or w (1)."""
    what = _expressions(m)
    direct = cs.jacobian(what, m.w if by else m.x)
    entries = direct.nz[:]
    moves = _any(_pattern(m, entries, 0)) | _any(_pattern(m, entries, 1))
    by_p = _pattern(m, entries, 2)
    tunable = np.array([not v.fixed for v in face.of("parameter")])
    kind = np.where(_pattern(m, what, by), 4, 0)  # where there is no slope, as of a condition, it still switches
    for e, (i, j) in enumerate(_places(direct)):
        kind[i, j] = 4 if moves[e] else 3 if (by_p[e] & tunable).any() else 2 if by_p[e].any() else 1
        if entries[e].is_zero():
            kind[i, j] = 0  # the terms cancel, as a push does in the push needed
    places = algebraic(m)
    if places:
        kind[_pattern(m, what, 0)[:, places] @ _algebraic_on(m, _pattern(m, m.f, by)[places])] = 4
    return kind


def _any(pattern: np.ndarray) -> np.ndarray:
    return np.asarray(pattern.any(axis=1))


def _places(matrix: cs.SX) -> Iterable[tuple[int, int]]:
    return zip(*matrix.sparsity().get_triplet(), strict=True)


def _at_start(m: Model) -> tuple[np.ndarray, np.ndarray]:
    """Dependence of each expression at the start on parameters, and on inputs."""
    what, places = _expressions(m), algebraic(m)
    f_x, what_x = _pattern(m, m.f, 0), _pattern(m, what, 0)
    found = []
    for by in (2, 1):
        x_on = _pattern(m, m.start, by)
        if places:
            rows = _pattern(m, m.f, by)[places] | (_pattern(m, m.mass, by)[places] if by == 2 else False)
            others = [i for i in range(m.x.numel()) if i not in places]
            x_on[places] |= _algebraic_on(m, rows | (f_x[np.ix_(places, others)] @ x_on[others]))
        found.append(_pattern(m, what, by) | (what_x @ x_on))
    return found[0], found[1]
