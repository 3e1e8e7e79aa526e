"""A compiled model is taken again for the same equations alone: effects of one name may have others."""

from __future__ import annotations

from dataclasses import replace

import pytest

from wheelchair_fmu.engine.cache import effect_key
from wheelchair_fmu.model.effects import defined
from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.stage import Effect, Row, adds
from wheelchair_fmu.quantities import N_S_M, M, N, Parameter, State

Q = Parameter("q", N, "constant part", off=0.0, smallest_interesting=0.4, lower=0.0, upper=20.0, source="a test")
K = Parameter("k", N_S_M, "viscous part", off=0.0, smallest_interesting=0.4, lower=0.0, upper=20.0, source="a test")
FILE = """
from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.stage import Effect, adds
from wheelchair_fmu.quantities import N, N_S_M, Parameter
COMMON = dict(off=0.0, smallest_interesting=1.0, lower=0.0, upper=9.0, source="a test")
Q, K = Parameter("q", N, "constant part", **COMMON), Parameter("k", N_S_M, "viscous part", **COMMON)
EFFECT = Effect("my_drag", "a drag", ({order}), (adds("F_x", law("-q - k * u")),))
"""


def by(factor: float) -> Effect:
    """A drag whose law has a number that stands in no text of its own."""
    return Effect("my_drag", "a drag", (K,), (adds("F_x", lambda k, u: -factor * k * u),))


def test_a_law_that_encloses_another_number_is_another_model():
    assert effect_key(by(1.0)) == effect_key(by(1.0)) != effect_key(by(2.0))


@pytest.mark.parametrize(
    "other",
    [
        lambda e: replace(e, parameters=(K, Q)),
        lambda e: replace(e, parameters=(Q,), constants=(replace(K, off=None),)),
        lambda e: replace(e, parameters=(replace(Q, symbol="k"), replace(K, symbol="q"))),
        lambda e: replace(e, rows=(replace(e.rows[0], state=replace(e.rows[0].state, nominal=2.0)),)),
    ],
)
def test_other_records_of_the_same_laws_are_other_models(other):
    row = Row(State("lag", M, "a lag"), law("1"), law("-lag"))
    effect = Effect("my_drag", "a drag", (Q, K), (adds("F_x", law("-q - k * u")),), rows=(row,))
    assert effect_key(other(effect)) != effect_key(effect)


def test_files_that_differ_in_the_order_of_parameters_are_other_models():
    one, two = (defined((("my_drag.py", FILE.replace("{order}", order)),))["my_drag"] for order in ("Q, K", "K, Q"))
    assert effect_key(one) != effect_key(two)
