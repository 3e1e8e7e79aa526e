"""Derivatives of the step map itself, stage by stage through one factorisation.

With U_i as in `rodas`, differentiating  W U_i = f(x_i, w_i, p) + M Σ (c_ij/h) U_j + γ_i ∂f/∂w Δw  gives

    W dU_i = F_x(i) (dx + Σ a_ij dU_j) + M Σ (c_ij/h) dU_j + R_i
    R_i = F_w(i) dw_i + F_p(i) dp + γ_i F_w d(Δw) + d[J U_i + γ_i F_w Δw] + dM (Σ (c_ij/h) U_j − U_i/(hγ))

There are more directions than states, so a step's end x₁ = x + Σ b_i U_i is derived from its last stage back to the first:

    G_i = ∂x₁/∂R_i = (b_i + Σ_{j>i} G_j (a_ji F_x(j) + M c_ji/h)) W⁻¹,    dx₁ = dx + Σ G_i (F_x(i) dx + R_i)

These are the functions it needs; `csrc/tangent.c` does the sums, of the U_i too. A model with no special structure in mind: any
states, pushes as the noisy inputs, any parameters.

d[J U_i + γ_i F_w Δw], all at the step's start, is how F there moves along (U_i, γ_i Δw): a derivative in one direction, which
is less work than all second derivatives would be. What of it is the same for every stage is evaluated once a step.

    motion(x, w, p)          → f (nx)
    ramp(x, w, p, dw)        → F_w dw (nx)             by all inputs
    slopes(x, w, p)          → F (nx, nx + 4)          by states and pushes
    prepare(x, w, p)         → what the next needs of a step's start, once for all stages
    bend(prepared, U, dw)    → d[J U + F_w dw] (nx, nx + 4)
    readout(x, w, p)         → dy of the sensors (ns, nx + 4 + nc)
    masses(p)                → M (nx), dM (nx, nc)
    begin(x, w, p)           → derivative of the consistent start x (nx, nc)

`slopes_all`, `prepare_all` and `bend_all` go on with nc columns by parameters, and are run only where somebody asks for any.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass

import casadi as cs

from ..model.wheelchair import Model
from ..quantities import Parameter
from .kernel import _algebraic_change

NAMES = ("motion", "ramp", "slopes", "prepare", "bend", "slopes_all", "prepare_all", "bend_all", "readout", "masses", "begin")
SENSORS = "sensor."
PUSHES = 4  # the first inputs, F_rl, F_rr, M_rl, M_rr, carry noise,
BODY = "rider.momentum"  # and the next one does where it moves,
EXTERNAL = ("external.force", "external.moment")  # and the next two, as what acts and was not recorded


@dataclass(frozen=True)
class Tangent:
    """The functions above, and what their columns and the readout's rows are."""

    columns: tuple[Parameter, ...]
    rows: tuple[int, ...]
    places: tuple[int, ...]  # of the columns among the model's parameters
    touched: tuple[int, ...]  # row * columns + column of every equation that moves with a parameter
    functions: dict[str, cs.Function]

    def length(self, name: str) -> int:
        """How many numbers a function gives."""
        return int(self.functions[name].numel_out(0))


def differentiable(model: Model, names: Sequence[str] | None = None) -> tuple[Parameter, ...]:
    """Parameters that a fit may touch, or those of them that have these `names`: no choices, regularisations, gravity or
    fixed constants."""
    return tuple(
        p
        for p in model.parameters
        if not p.choices
        and (p.estimated or p.adjusted)
        and not p.name.startswith(("regularisation.", "speed."))
        and p.name != "g"
        and (names is None or p.name in names)
    )


def sensed(model: Model) -> tuple[int, ...]:
    """Places of the results that instruments read."""
    return tuple(i for i, o in enumerate(model.outputs) if o.name.startswith(SENSORS))


def noisy(moving: Container[str]) -> int:
    """How many of the first inputs carry noise, if these inputs move besides the pushes."""
    return PUSHES + 1 + len(EXTERNAL) if EXTERNAL[0] in moving else PUSHES + (BODY in moving)


def tangent(model: Model, names: Sequence[str], pushes: int = PUSHES) -> Tangent:
    """Derive the functions of a model, by those parameters that have these `names`, in the model's order, and by the first
    `pushes`."""
    x, w, p = model.x, model.w, model.p
    columns, rows = differentiable(model, names), sensed(model)
    places = [model.parameters.index(c) for c in columns]
    at, motion = [x, w, p], cs.vertcat(x, w[:pushes])
    everything = cs.vertcat(motion, p[places])

    def by_columns(e: cs.SX) -> cs.SX:
        return cs.densify(cs.jacobian(e, p[places]))

    y, dw = model.y[list(rows)], cs.SX.sym("dw", w.numel())
    functions = {
        "motion": cs.Function("motion", at, cs.cse([cs.densify(model.f)])),
        "ramp": cs.Function("ramp", [*at, dw], cs.cse([cs.densify(cs.jtimes(model.f, w, dw))])),
        **_bending(model, motion, ""),
        **_bending(model, everything, "_all"),
        "readout": cs.Function("readout", at, cs.cse([_rows(cs.densify(cs.jacobian(y, everything)))])),
        "masses": cs.Function("masses", [p], [cs.densify(model.mass), _rows(by_columns(model.mass))]),
        "begin": cs.Function("begin", at, [_rows(cs.densify(_begin(model, places)))]),
    }
    return Tangent(columns, rows, tuple(places), _touched(model, p[places]), functions)


def _touched(model: Model, columns: cs.SX) -> tuple[int, ...]:
    """Places, in a matrix by rows, where M x' = f moves with a column: f and M themselves, or a slope of f."""
    slopes = cs.jacobian(model.f, cs.vertcat(model.x, model.w))
    of = [(model.f, range(model.x.numel())), (model.mass, range(model.x.numel())), (slopes.nz[:], slopes.sparsity().row())]
    found = {(rows[i], j) for e, rows in of for i, j in zip(*cs.jacobian_sparsity(e, columns).get_triplet(), strict=True)}
    return tuple(sorted(row * columns.numel() + column for row, column in found))


def _bending(model: Model, by: cs.SX, suffix: str) -> dict[str, cs.Function]:
    """`slopes`, `prepare` and `bend` by some of the model's variables (k,)."""
    at = [model.x, model.w, model.p]
    slopes = cs.jacobian(model.f, by)
    along = [cs.SX.sym("U", model.x.numel()), cs.SX.sym("dw", model.w.numel())]
    bent = cs.cse(cs.jtimes(slopes.nz[:], cs.vertcat(*at[:2]), cs.vertcat(*along)))
    bent, names, known = cs.extract_parametric(bent, cs.vertcat(*at))
    others = {s.element_hash() for s in cs.vertsplit(cs.vertcat(*names, *along))}
    bare = [s for s in cs.symvar(bent) if s.element_hash() not in others]  # of x, w and p
    bend = cs.SX(slopes.sparsity(), bent)
    outputs = {
        "slopes": (at, _rows(cs.densify(slopes))),
        "prepare": (at, cs.vertcat(*known, *bare)),
        "bend": ([cs.vertcat(*names, *bare), *along], _rows(cs.densify(bend))),
    }
    return {n + suffix: cs.Function(n + suffix, given, cs.cse([result])) for n, (given, result) in outputs.items()}


def _rows(matrix: cs.SX) -> cs.SX:
    """CasADi stores columns one after the other; C reads rows."""
    return matrix.T


def _begin(model: Model, places: list[int]) -> cs.SX:
    """dx(0)/dp, algebraic states following the others."""
    start = cs.jacobian(model.start, model.p)[:, places]
    seed = cs.SX.eye(model.p.numel())[:, places]
    slopes = cs.jacobian(model.f, cs.vertcat(model.x, model.p))
    return start + _algebraic_change(model, slopes @ cs.vertcat(start, seed))
