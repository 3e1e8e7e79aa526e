"""Divide once by each divisor: a / b and c / b as a q and c q with q = 1 / b.

A step of the model divides some 280 times by 80 different numbers, and a division takes a processor as long as four products.
A compiler's option (-freciprocal-math) would do the same, but not the same arithmetic on every platform.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import casadi as cs


def dividing_once(function: cs.Function, name: str) -> cs.Function:
    """The same function of symbols under another name; results differ by rounding."""
    inputs = function.sx_in()
    given = [cs.vertsplit(x.nz[:]) if x.nnz() else [] for x in inputs]
    results = [[cs.SX(0)] * function.nnz_out(i) for i in range(function.n_out())]
    work: dict[int, cs.SX] = {}
    inverse: dict[int, tuple[cs.SX, cs.SX]] = {}  # by where in memory its divisor is, which is kept so that it stays there
    with _as_written():
        for k in range(function.n_instructions()):
            op, at, to = function.instruction_id(k), function.instruction_input(k), function.instruction_output(k)
            if op == cs.OP_INPUT:
                work[to[0]] = given[at[0]][at[1]]
            elif op == cs.OP_OUTPUT:
                results[to[0]][to[1]] = work[at[0]]
            elif op == cs.OP_CONST:
                work[to[0]] = cs.SX(function.instruction_constant(k))
            elif op == cs.OP_DIV:
                divisor = work[at[1]]
                place = divisor.element_hash()
                if place not in inverse:
                    inverse[place] = 1 / divisor, divisor
                work[to[0]] = work[at[0]] * inverse[place][0]
            elif len(at) == 1:
                work[to[0]] = cs.SX.unary(op, work[at[0]])
            else:
                work[to[0]] = cs.SX.binary(op, *(work[i] for i in at))
    shapes = [function.sparsity_out(i) for i in range(function.n_out())]
    return cs.Function(name, inputs, [cs.SX(shape, cs.vertcat(*r)) for shape, r in zip(shapes, results, strict=True)])


@contextmanager
def _as_written() -> Iterator[None]:
    """CasADi takes a product with an inverse for a division, and makes one of it."""
    cs.GlobalOptions.setSimplificationOnTheFly(False)
    try:
        yield
    finally:
        cs.GlobalOptions.setSimplificationOnTheFly(True)
