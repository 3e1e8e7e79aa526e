"""The functions a simulation needs, as CasADi functions of one model.

    start(p, w)                          → x     states at the start, algebraic ones not yet in place
    project(x, w, p)                     → x     one Newton step that puts algebraic rows right
    step(x, w0, w1, h, p)                → x1, error, d2, d3   one step of Rodas4
    plain(x, w0, w1, h, p)               → the same, on a level floor with open brakes, which is a third less work;
                                           none where the model is such a chair's anyway, or nearly (`at_rest`)
    bare(x, w0, w1, h, p)                → the same, and all effects off besides
    output(x, w, p)                      → y
    bare_output(x, w, p)                 → the same where a bare step would be taken
    forward(x, w, p, dx, dw, dp)         → dy, dx'  derivatives along a direction
    rate(x, w, p)                        → x', z    algebraic states rest; results that are true or false switch where z does
    mass(p)                              → m     of each row; zero where it is algebraic

These are all that the Python tools and the FMUs run; the report page takes the same steps in loops over
their stages (`csrc/rodas.c`), which is less code.
"""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass, replace

import casadi as cs

from ..errors import ModelError
from ..model.chassis import INPUTS, ROWS
from ..model.wheelchair import Model
from .lu import factorise
from .rodas import step

NAMES = ("start", "project", "step", "plain", "bare", "output", "bare_output", "forward", "rate", "mass")
WORTH = 0.9  # of a step's operations: a plain one of more is not compiled, as of a model in which hardly anything moves besides
SIMULATED = ("start", "project", "step", "plain", "bare", "output", "mass")  # what it takes to simulate a run


@dataclass(frozen=True)
class Kernel:
    """One model and its functions, by the names above."""

    model: Model
    functions: dict[str, cs.Function]


def kernel(model: Model, names: Container[str] = NAMES) -> Kernel:
    """Derive those of a model's functions that have these `names`, and that it has."""
    x, w, p = model.x, model.w, model.p
    makers = {
        "start": lambda: cs.Function("start", [p, w], [model.start]),
        "project": lambda: cs.Function("project", [x, w, p], [_projected(model)]),
        "step": lambda: _step(model, "step"),
        "output": lambda: cs.Function("output", [x, w, p], cs.cse([model.y])),
        "forward": lambda: _forward(model),
        "rate": lambda: cs.Function("rate", [x, w, p], cs.cse([rate(model), crossings(model)])),
        "mass": lambda: cs.Function("mass", [p], [cs.densify(model.mass)]),
    }
    if seldom(model):
        makers["plain"] = lambda: _step(at_rest(model), "plain")
        if switches(model):
            off = _off(at_rest(model))
            makers["bare"] = lambda: _step(off, "bare")
            makers["bare_output"] = lambda: cs.Function("bare_output", [x, w, p], cs.cse([off.y]))
    functions = {name: make() for name, make in makers.items() if name in names}
    if functions.keys() >= {"step", "plain"} and _work(functions["plain"]) > WORTH * _work(functions["step"]):
        del functions["plain"]
    return Kernel(model, functions)


def _work(function: cs.Function) -> int:
    return int(function.n_instructions())


def seldom(model: Model) -> list[int]:
    """Places of the inputs that move the model, and that most runs leave at their start."""
    moves = cs.vertcat(model.f, model.y)
    return [i for i, u in enumerate(model.inputs) if u.seldom and cs.depends_on(moves, model.w[i])]


def seldom_among(inputs: Iterable[str]) -> list[str]:
    """Those of these inputs, in order, that most runs leave at their start."""
    return sorted({i.name for i in INPUTS if i.seldom}.intersection(inputs))


def at_rest(model: Model, moving: Container[str] = ()) -> Model:
    """The model with those inputs, but for the `moving` ones, at their starts whatever they are: a chair on a level floor with
    open brakes."""
    places = [i for i in seldom(model) if model.inputs[i].name not in moving]
    starts = cs.DM([model.inputs[i].start for i in places])
    f, y, start = cs.substitute([model.f, model.y, model.start], [model.w[places]], [starts])
    return replace(model, f=f, y=y, start=start)


def switches(model: Model) -> list[int]:
    """Places of the parameters that are zero where all effects are off."""
    return [i for i, p in enumerate(model.parameters) if p.off is not None]


def _off(model: Model) -> Model:
    """The model with its effects off, whatever their parameters are."""
    places = switches(model)
    f, y, mass = cs.substitute([model.f, model.y, model.mass], [model.p[places]], [cs.DM.zeros(len(places))])
    return replace(model, f=f, y=y, mass=mass)


def _step(model: Model, name: str) -> cs.Function:
    s = step(model)
    return cs.Function(name, [model.x, model.w, s.w1, s.h, model.p], cs.cse([s.x1, s.error, s.d2, s.d3]))


def algebraic(model: Model) -> list[int]:
    """Places of the states whose mass is zero, or zero for some parameters."""
    rows = range(len(ROWS), model.x.numel())
    return [i for i in rows if model.mass[i].is_zero() or not model.mass[i].is_constant()]


def _resting(model: Model, places: list[int]) -> cs.SX:
    """1 where the mass is zero as the parameters stand, else 0."""
    return cs.vertcat(*(model.mass[i] == 0 for i in places))


def _algebraic_change(model: Model, residual: cs.SX) -> cs.SX:
    """dx (nx, m) that takes the algebraic rows' `residual` (nx, m) to zero, to first order; zero in all other rows."""
    places = algebraic(model)
    change = cs.SX.zeros(*residual.shape)
    if places:
        off = _resting(model, places)
        jacobian = cs.jacobian(model.f[places], model.x[places])
        identity = cs.SX.eye(len(places))
        gated = cs.diag(off) @ jacobian + cs.diag(1 - off) @ identity
        change[places, :] = factorise(gated).solve(cs.diag(-off) @ residual[places, :])
    return change


def _projected(model: Model) -> cs.SX:
    return model.x + _algebraic_change(model, model.f)


def _forward(model: Model) -> cs.Function:
    """Along (dx, dw, dp), where algebraic states follow the others whatever dx says of them."""
    at = [model.x, model.w, model.p]
    dx, dw, dp = (cs.SX.sym(f"d{v}", s.numel()) for v, s in zip("xwp", at, strict=True))
    places = algebraic(model)
    if places:
        dx_given = cs.SX(dx)
        dx_given[places] = (1 - _resting(model, places)) * dx[places]
    else:
        dx_given = dx
    everything = cs.vertcat(*at)
    tangent = cs.jtimes(model.f, everything, cs.vertcat(dx_given, dw, dp))
    dx_full = dx_given + _algebraic_change(model, tangent)
    along = cs.vertcat(dx_full, dw, dp)
    dy, d_rate = (cs.jtimes(e, everything, along) for e in (model.y, rate(model)))
    return cs.Function("forward", [*at, dx, dw, dp], cs.cse([dy, d_rate]))


def rate(model: Model) -> cs.SX:
    """x' by M x' = f, and zero where the mass is zero."""
    rates = cs.SX(model.f)
    maybe = algebraic(model)
    for i in range(model.x.numel()):
        off = model.mass[i] == 0 if i in maybe else 0
        rates[i] = (1 - off) * model.f[i] / (model.mass[i] + off)
    return rates


def crossings(model: Model) -> cs.SX:
    """For each result that is true or false, what is positive while it is false."""
    switches = [model.y[i] for i, o in enumerate(model.outputs) if o.boolean]
    for s in switches:
        if s.op() not in (cs.OP_LE, cs.OP_LT):
            raise ModelError("a result that is true or false is not written as an inequality; write it as a <= b")
    return cs.vertcat(*(s.dep(0) - s.dep(1) for s in switches))
