"""Equations and their slopes are finite at standstill, and the slopes are those of the equations."""

from __future__ import annotations

import casadi as cs
import numpy as np

from ..engine.kernel import algebraic, rate
from ..model.stage import Effect
from ..model.wheelchair import Model
from ..quantities import Quantity
from .laws import Line, Values, lines, values_at
from .places import Place, anywhere, at_rest
from .subject import Breach, Subject

STEP = 1e-6  # of central differences, beside the sizes of what is varied
CLOSE = 2e-5  # of a slope, with such a step
SMALL = 2e-6  # of the largest slope
LEAST = 1e-2  # size of what is varied, where it is smaller
ABRUPT = 0.5  # of a slope at rest, where equations bend sharply: with a jump, differences are larger by many powers of ten
NAME = "exact derivative"
NO_JUMPS = "write the law of CasADi's smooth functions, direction(u, v_eps) for the sign, and of nothing that jumps"
TIMES = 3  # directions


def finite(subject: Subject) -> list[Breach]:
    """Off, on and turned round."""
    model = subject.model
    z = cs.vertcat(model.x, model.w, model.p)
    rows = cs.vertcat(model.f, model.y)
    values = cs.Function("rest", [model.x, model.w, model.p], [rows, cs.jacobian(rows, z)])
    for size, words in ((0.0, "off"), (1.0, "on"), (-1.0, "on, with its parameters negative")):
        value, slopes = (v.full() for v in values.call(list(vars(at_rest(model, subject.values(size))).values())))
        cure = "keep roots, quotients and |x| away from zero, as magnitude(u, v_eps) from wheelchair_fmu.model.smooth does"
        for i, _ in np.argwhere(~np.isfinite(value))[:1]:
            return [subject.breach("finite at standstill", f"{words} and at rest, {_row(model, i)} is {value[i, 0]}", cure)]
        for i, j in np.argwhere(~np.isfinite(slopes))[:1]:
            by = _names((*model.states, *model.inputs, *model.parameters))[j]
            return [
                subject.breach(
                    "finite at standstill",
                    f"{words} and at rest, the slope of {_row(model, i)} by {by} is {slopes[i, j]}",
                    cure,
                )
            ]
    return []


def derivative(subject: Subject) -> list[Breach]:
    """The model's slopes along random directions agree with central differences at 1 m/s, and each law's own at rest."""
    return moving(subject) or [breach for effect in subject.effects for breach in _at_rest(subject, effect)]


def moving(subject: Subject) -> list[Breach]:
    """Asked of the whole model."""
    model, rng = subject.model, np.random.default_rng(5)
    place = anywhere(model, subject.values(1.0), rng, 1.0, spread=0.05)
    value, slope = _along(model, cs.vertcat(_rates(model), model.y))
    sizes = [np.maximum(np.abs(v), LEAST) for v in vars(place).values()]
    for _ in range(TIMES):
        direction = [rng.normal(size=len(s)) * s for s in sizes]
        direction[2] *= [not q.choices for q in model.parameters]
        said = slope.call([*vars(place).values(), *direction])[0].full().ravel()
        found = _differences(value, place, direction)
        off = abs(said - found) - CLOSE * abs(found) - SMALL * (abs(found).max() + 1)
        i = int(np.argmax(off))
        if off[i] > 0:
            return [
                subject.breach(
                    NAME,
                    f"at 1 m/s {_row(model, i)} changes by {found[i]:.6g} along some direction, but its "
                    f"derivative says {said[i]:.6g}",
                    NO_JUMPS,
                )
            ]
    return []


def _at_rest(subject: Subject, effect: Effect) -> list[Breach]:
    """Where the sign of a speed jumps. The law alone is asked: the angle of a caster at rest, say, has no slope itself."""
    rest = values_at(subject, at_rest(subject.model, subject.values(1.0)))[effect.id]
    for line in lines(subject, effect):
        at = {n: line.fixed[n] if n in line.fixed else rest[n] for n in line.symbols}
        said, found = line.slopes(at), _slopes(line, at)
        allowed = ABRUPT * (abs(said) + float(np.max(abs(line.at(at)), initial=0.0)) / LEAST + 1)
        for i, j in np.argwhere(abs(found - said) > allowed)[:1]:
            name = [n for n, value in at.items() for _ in value][j]
            rate = f"{line.unit.name} per {line.units[name].name} of {name}"
            fact = f"at rest {line.words} changes by {found[i, j]:.3g} {rate}, but its derivative says {said[i, j]:.3g}"
            return [Breach(effect.id, NAME, fact, NO_JUMPS)]
    return []


def _slopes(line: Line, at: Values) -> np.ndarray:
    """Of each component by each component of what it reads, (m, n), by central differences."""
    columns = []
    for name, value in at.items():
        for axis in np.eye(len(value)):
            step = STEP * max(abs(float(axis @ value)), LEAST)
            one, other = (line.at({**at, name: value + sign * step * axis}) for sign in (1, -1))
            columns.append((one - other) / (2 * step))
    return np.array(columns).T


def _along(model: Model, rows: cs.SX) -> tuple[cs.Function, cs.Function]:
    """The rows, and their slopes along a direction."""
    at = [model.x, model.w, model.p]
    along = [cs.SX.sym("d", v.numel()) for v in at]
    slope = cs.jtimes(rows, cs.vertcat(*at), cs.vertcat(*along))
    return cs.Function("value", at, [rows]), cs.Function("slope", [*at, *along], [slope])


def _differences(value: cs.Function, place: Place, along: list[np.ndarray]) -> np.ndarray:
    one, other = (value(*(v + s * STEP * d for v, d in zip(vars(place).values(), along, strict=True))) for s in (1, -1))
    return ((one - other) / (2 * STEP)).full().ravel()


def _rates(model: Model) -> cs.SX:
    """x' of moving states, and the residuals of algebraic rows."""
    still = algebraic(model)
    rates = rate(model)
    for i in still:
        rates[i] = model.f[i]
    return rates


def _row(model: Model, i: int) -> str:
    states = _names(model.states)
    return f"the equation of {states[i]}" if i < len(states) else _names(model.outputs)[i - len(states)]


def _names(records: tuple[Quantity, ...]) -> list[str]:
    return [name for r in records for name in r.names]
