"""What the model must satisfy with every effect, with all of them and with none."""

from __future__ import annotations

import casadi as cs
import numpy as np
import pytest

from tests.kit import anywhere, variant_with
from wheelchair_fmu.contracts import Subject, mirror
from wheelchair_fmu.contracts.places import Place, evaluate, mirrored_place
from wheelchair_fmu.contracts.smooth import finite
from wheelchair_fmu.engine.kernel import kernel, rate
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

EFFECTS = bundled()
LAWS = {"slipping": Choice(caster="slipping"), "spinning": Choice(wheel="spinning")}
CASES = [(), *((e,) for e in EFFECTS), tuple(EFFECTS), *LAWS]  # none, one, all; laws with states


def name(case: tuple[str, ...] | str) -> str:
    if isinstance(case, str):
        return case
    return "none" if not case else case[0] if len(case) == 1 else "all"


@pytest.fixture(params=CASES, ids=name)
def variant(request) -> Variant:
    return Variant(LAWS[request.param]) if isinstance(request.param, str) else variant_with(*request.param)


def test_mirror_and_standstill(variant):
    """A mirrored chair in a mirrored motion has mirrored forces; at rest equations and all their slopes are finite."""
    subject = Subject(variant.active(), variant.model(), Variant(variant.choice).model())
    assert [*mirror(subject), *finite(subject)] == []


def test_mirror_twice_is_nothing(variant):
    model, place = variant.model(), anywhere(variant, np.random.default_rng(2))
    back = mirrored_place(model, mirrored_place(model, place))
    for one, two in zip(vars(place).values(), vars(back).values(), strict=True):
        np.testing.assert_array_equal(one, two)


def test_units(variant):
    """In other units of mass, length and time every number changes as its unit says."""
    rng, model = np.random.default_rng(3), variant.model()
    kms = (1.7, 0.6, 2.3)
    place = anywhere(variant, rng, 1.0)

    def scales(records):
        return np.array([r.unit.scale(*kms) for r in records for _ in r.names])

    other = Place(place.x * scales(model.states), place.w * scales(model.inputs), place.p * scales(model.parameters))
    mass, f, y = evaluate(model, place, model.mass, model.f, model.y)
    mass2, f2, y2 = evaluate(model, other, model.mass, model.f, model.y)
    np.testing.assert_allclose(y2, y * scales(model.outputs), rtol=1e-9, atol=1e-9)
    rate = np.array(scales(model.states)) / kms[2]
    moving = mass != 0
    np.testing.assert_allclose((f2[moving] / mass2[moving]), f[moving] / mass[moving] * rate[moving], rtol=1e-9)
    np.testing.assert_allclose(f2[~moving], f[~moving] * scales(model.states)[~moving], rtol=1e-9, atol=1e-9)


def test_derivatives_are_exact(variant):
    """`forward` agrees with central differences by every state, input and parameter."""
    rng, model = np.random.default_rng(5), variant.model()
    forward = kernel(model).functions["forward"]
    place = anywhere(variant, rng, 1.0, spread=0.05)
    sizes = [np.maximum(np.abs(v), 1e-2) for v in vars(place).values()]
    mass = evaluate(model, place, model.mass)[0]
    places = np.flatnonzero(mass == 0)
    for _ in range(5):
        direction = [rng.normal(size=len(s)) * s for s in sizes]
        direction[2] *= [not q.choices for q in model.parameters]
        dy, dx_rate = (d.full().ravel() for d in forward.call([*vars(place).values(), *direction]))
        along = _consistent(model, place, direction, places)
        expected_y, expected_rate = _central(model, place, along)
        scale = np.abs(expected_y).max() + 1
        np.testing.assert_allclose(dy, expected_y, rtol=2e-5, atol=2e-6 * scale)
        np.testing.assert_allclose(dx_rate, expected_rate, rtol=2e-5, atol=2e-6 * np.abs(expected_rate).max())


def _consistent(model, place, direction, places):
    """The direction with algebraic states following, by dense linear algebra."""
    dx, dw, dp = (d.copy() for d in direction)
    if len(places):
        fx, fw, fp = (
            m[places] for m in evaluate(model, place, *(cs.jacobian(model.f, v) for v in (model.x, model.w, model.p)))
        )
        dx[places] = 0
        dx[places] = np.linalg.solve(fx[:, places], -(fx @ dx + fw @ dw + fp @ dp))
    return dx, dw, dp


def _central(model, place, along, h=1e-6):
    ends = [Place(*(v + s * h * d for v, d in zip(vars(place).values(), along, strict=True))) for s in (1, -1)]
    (r1, y1), (r2, y2) = (evaluate(model, end, rate(model), model.y) for end in ends)
    return (y1 - y2) / (2 * h), (r1 - r2) / (2 * h)
