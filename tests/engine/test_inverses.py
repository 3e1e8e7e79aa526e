"""Divisions that are made once."""

from __future__ import annotations

import casadi as cs
import numpy as np
import pytest

from wheelchair_fmu.engine.inverses import dividing_once
from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.model.variant import Variant

DIVISIONS = (cs.OP_DIV, cs.OP_INV)


def divisions(function: cs.Function) -> int:
    return sum(function.instruction_id(k) in DIVISIONS for k in range(function.n_instructions()))


def test_what_is_divided_by_the_same_is_divided_once():
    a, b, c, d = (cs.SX.sym(n) for n in "abcd")
    plain = cs.Function("f", [cs.vertcat(a, b), cs.vertcat(c, d)], [cs.vertcat(a / c, b / c, a / d), cs.sin(a / c) / (b + 2)])
    once = dividing_once(plain, "g")
    assert once.name() == "g"
    assert divisions(once) == 3 < divisions(plain)
    at = ([1.5, -2.5], [0.3, 7.0])
    for expected, found in zip(plain(*at), once(*at), strict=True):
        np.testing.assert_allclose(found, expected, rtol=4e-16)


def test_other_expressions_are_simplified_as_before():
    a, b = cs.SX.sym("a"), cs.SX.sym("b")
    dividing_once(cs.Function("f", [a, b], [a / b]), "g")
    assert (a * (1 / b)).op() == cs.OP_DIV


@pytest.mark.parametrize("name", ["step", "output", "forward", "rate", "project"])
def test_a_model_is_the_same_but_for_rounding(name):
    plain = kernel(Variant().with_effects(["tyre_saturation", "caster_trail", "relaxation_length"]).model()).functions[name]
    once = dividing_once(plain, name)
    rng = np.random.default_rng(5)
    for _ in range(5):
        at = [rng.uniform(0.1, 2.0, plain.size_in(i)) for i in range(plain.n_in())]
        for expected, found in zip(map(np.array, plain.call(at)), map(np.array, once.call(at)), strict=True):
            np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12 * float(np.abs(expected).max(initial=0)))
    assert divisions(once) < divisions(plain)
    assert once.sparsity_out(0) == plain.sparsity_out(0)
