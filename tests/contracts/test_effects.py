"""What every effect in the catalogue must satisfy, from its record alone."""

from __future__ import annotations

import re

import numpy as np
import pytest

from tests.kit import Place, anywhere, evaluate, variant_with
from wheelchair_fmu.errors import ModelError
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.stage import Effect, adds
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import assemble

EFFECTS = bundled()


@pytest.fixture(params=list(EFFECTS))
def effect(request) -> Effect:
    return EFFECTS[request.param]


def test_record_is_complete(effect):
    assert re.fullmatch(r"[a-z][a-z_]*", effect.id)
    assert effect.title
    assert effect.title[0].islower()
    for p in effect.parameters:
        assert p.off == 0 and p.default == 0, "off is zero"
        assert p.smallest_interesting and p.smallest_interesting > 0
        assert p.lower <= 0 < p.smallest_interesting < p.upper
        assert np.isfinite([p.lower, p.upper]).all(), "every parameter has bounds"
        assert p.meaning and p.source


def test_neutral_when_off(effect):
    """With its parameters at zero the chair moves as without the effect."""
    on = Variant().with_effects([effect.id])
    off = Variant(choice=on.choice)
    rng = np.random.default_rng(11)
    for speed in (1.0, 0.0, -0.6):
        place = anywhere(off, rng, speed)
        base = off.model()
        f0, y0 = evaluate(base, place, base.f, base.y)
        model = on.model()
        extra = model.x.numel() - base.x.numel()
        x = np.concatenate([place.x, np.zeros(extra)])
        p = np.concatenate([place.p, on.vector()[len(place.p) :]])
        x = _settled(model, x, place.w, p)
        f1, y1 = evaluate(model, Place(x, place.w, p), model.f, model.y)
        np.testing.assert_allclose(f1[: len(f0)], f0, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(y1[: len(y0)], y0, rtol=1e-12, atol=1e-12)


def _settled(model, x, w, p):
    """Algebraic states in their places."""
    from wheelchair_fmu.engine.kernel import kernel

    project = kernel(model).functions["project"]
    for _ in range(5):
        x = project(x, w, p).full().ravel()
    return x


def test_it_does_something(effect):
    """At its smallest interesting size something changes: the equations, the mass or a reading."""
    if effect.delays_record:
        pytest.skip("shifts the record, not the chair")
    variant = variant_with(effect.id)
    model, rng = variant.model(), np.random.default_rng(12)
    place = anywhere(variant, rng, 1.0, spread=0)
    off = Place(place.x, place.w, Variant().with_effects([effect.id]).vector())
    on = evaluate(model, place, model.f, model.mass, model.y)
    without = evaluate(model, off, model.f, model.mass, model.y)
    assert any(not np.array_equal(a, b) for a, b in zip(on, without, strict=True))


def test_opposes_motion_where_it_says_so(effect):
    variant, rng = variant_with(effect.id), np.random.default_rng(13)
    model = variant.model()
    off = Variant().with_effects([effect.id]).vector()
    promises = [c for c in effect.contributions if c.opposes]
    if not promises:
        pytest.skip("promises nothing")
    for contribution in promises:
        for speed in np.linspace(-1, 1, 21):
            place = anywhere(variant, rng, speed, spread=0)
            force, velocity = evaluate(model, place, model.quantities[contribution.to],
                                       model.quantities[contribution.opposes])  # fmt: skip
            (without,) = evaluate(model, Place(place.x, place.w, off), model.quantities[contribution.to])
            assert np.all((force - without) * velocity <= 1e-12)


def test_order_does_not_matter():
    ids = list(EFFECTS)
    one, two = variant_with(*ids), variant_with(*ids[::-1])
    place = anywhere(one, np.random.default_rng(14))
    models = one.model(), two.model()
    np.testing.assert_array_equal(evaluate(models[0], place, models[0].f)[0],
                                  evaluate(models[1], place, models[1].f)[0])  # fmt: skip


def test_misfits_are_refused():
    good = EFFECTS["rolling_resistance_speed"]
    with pytest.raises(ModelError, match="needs the caster law 'swivelling'"):
        assemble(effects=[EFFECTS["caster_friction"]])
    with pytest.raises(ModelError, match="reads 'F_x', which is only known further down the line"):
        assemble(effects=[Effect("early", "early", good.parameters, (adds("N_r", lambda F_x: F_x),))])
    with pytest.raises(ModelError, match="reads 'nonsense', which is no quantity of this model"):
        assemble(effects=[Effect("odd", "odd", good.parameters, (adds("F_x", lambda nonsense: nonsense),))])
    with pytest.raises(Exception, match="no quantity for effect lost to act on 'F_z'"):
        assemble(effects=[Effect("lost", "lost", good.parameters, (adds("F_z", lambda u, k: -k * u),))])
    with pytest.raises(ModelError, match="gives F_x a term of shape"):
        assemble(effects=[Effect("wide", "wide", good.parameters, (adds("F_x", lambda v_xr, k: -k * v_xr),))])
