"""Many chairs side by side: each is what it is alone."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.engine import cache
from wheelchair_fmu.engine.ensemble import Ensemble
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.errors import SimulationError
from wheelchair_fmu.handling.manoeuvres import manoeuvre
from wheelchair_fmu.model.variant import Variant

from ..kit import variant_with

NAMES = ("chair.x", "chair.y", "chair.u", "chair.psi_dot", "slip.rl", "slip.rr", "push.total_needed", "load.lifted")
CHAIRS = 21


def case(variant, name, rng):
    """Times, inputs, and parameters of chairs that differ in everything that a plan would vary."""
    simulator, m = Simulator(variant), manoeuvre(name)
    places = {p.name: i for i, p in enumerate(variant.parameters())}
    own = variant.vector()
    for key, value in m.values.items():
        own[places[key]] = ("free", "prescribed").index(value) + 1 if isinstance(value, str) else value
    p = np.tile(own, (CHAIRS, 1))
    for key in ("chair.m", "chair.b", "tyre.C_lambda", "tyre.C_m_lambda", "resistance.f_f"):
        p[:, places[key]] *= rng.uniform(0.7, 1.3, CHAIRS)
    return simulator, m.time, simulator.inputs(len(m.time), m.inputs), p


def one_by_one(simulator, t, w, p):
    return np.array([[simulator.run(t, w, row)[name] for name in NAMES] for row in p])


def assert_same(found, expected):
    """To 1e-12 of the size that a result has in any of the runs."""
    size = np.abs(expected).max(axis=(0, 2), keepdims=True)
    assert np.all(np.abs(found - expected) <= 1e-12 * size), np.abs(found - expected).max(axis=(0, 2)) / size.ravel()


@pytest.mark.parametrize("name", ["steady-turn", "slalom", "start-stop"])
def test_chairs_side_by_side_are_as_alone(name):
    simulator, t, w, p = case(Variant(), name, np.random.default_rng(1))
    found = Ensemble(simulator, NAMES).run(t, w, p)
    assert found.errors == [None] * CHAIRS
    assert_same(found.results, one_by_one(simulator, t, w, p))


def test_where_rounding_decides_it_is_as_a_rounding():
    """A spin ends at a standstill, where steps are refused: there a last digit of the mass moves slip by a thousandth."""
    simulator, t, w, p = case(Variant(), "spin", np.random.default_rng(1))
    found, alone = Ensemble(simulator, NAMES).run(t, w, p).results, one_by_one(simulator, t, w, p)
    rounded = p.copy()
    rounded[:, [q.name for q in simulator.variant.parameters()].index("chair.m")] *= 1 + 1e-15
    off, moved = (np.abs(one - alone).max(axis=(0, 2)) for one in (found, one_by_one(simulator, t, w, rounded)))
    assert moved.max() > 1e-6 and np.all(off <= 10 * moved)


def with_effects(rng):
    """Every other chair has none."""
    variant = variant_with("rolling_resistance_asymmetry", "caster_friction", "tyre_saturation")
    simulator, t, w, p = case(variant, "slalom", rng)
    p[::2, [i for i, q in enumerate(variant.parameters()) if q.off is not None]] = 0
    return simulator, t, w, p


def test_some_with_effects_and_some_without():
    simulator, t, w, p = with_effects(np.random.default_rng(2))
    assert_same(Ensemble(simulator, NAMES).run(t, w, p).results, one_by_one(simulator, t, w, p))


@pytest.mark.nightly
def test_where_the_floor_begins_to_slope():
    simulator, t, w, p = with_effects(np.random.default_rng(7))
    w[len(t) // 2 :, [i.name for i in simulator.model.inputs].index("floor.slope_x")] = 0.02
    assert_same(Ensemble(simulator, NAMES).run(t, w, p).results, one_by_one(simulator, t, w, p))


def test_what_a_chair_gives_does_not_depend_on_its_company(monkeypatch):
    simulator, t, w, p = case(Variant(), "slalom", np.random.default_rng(3))
    together = Ensemble(simulator, NAMES).run(t, w, p).results
    for some in (slice(4, 5), slice(7, 20), [3, 1, 2]):
        assert np.array_equal(Ensemble(simulator, NAMES).run(t, w, p[some]).results, together[some])
    for width in [n for n in cache.VECTORS if n < cache.width()]:
        monkeypatch.setattr(cache, "width", lambda width=width: width)
        assert np.array_equal(Ensemble(simulator, NAMES).run(t, w, p).results, together)


def test_chairs_that_cannot_go_on_leave_the_others_alone():
    simulator, t, w, p = case(Variant(), "slalom", np.random.default_rng(4))
    well = Ensemble(simulator, NAMES).run(t, w, p).results
    ill = p.copy()
    ill[3, :] = np.nan
    ill[11, [q.name for q in simulator.variant.parameters()].index("chair.m")] = 0
    found = Ensemble(simulator, NAMES).run(t, w, ill)
    for i, error in enumerate(found.errors):
        if i not in (3, 11):
            assert error is None and np.array_equal(found.results[i], well[i])
            continue
        with pytest.raises(SimulationError) as alone:
            simulator.run(t, w, ill[i])
        assert error == str(alone.value) and np.isnan(found.results[i]).all()


def test_chairs_that_would_take_hours_are_refused_as_alone():
    simulator, t, w, p = case(Variant(), "slalom", np.random.default_rng(4))
    found = Ensemble(simulator, NAMES).run(t, w, p, tolerance=1e-30)
    with pytest.raises(SimulationError, match="too many would have been needed") as alone:
        simulator.run(t, w, p[0], tolerance=1e-30)
    assert found.errors[0] == str(alone.value) and None not in found.errors


def test_a_compiler_without_vectors_simulates_one_by_one(monkeypatch, caplog):
    simulator, t, w, p = case(Variant(), "slalom", np.random.default_rng(5))
    t, w = t[:200], w[:200]
    assert simulator.library  # compiled before what follows
    monkeypatch.setattr(cache, "VECTORS", {3: ("--no-such-option",)})
    monkeypatch.setattr(cache, "width", lambda: 3)
    with caplog.at_level("INFO"):
        found = Ensemble(simulator, NAMES).run(t, w, p)
    assert "chairs are simulated one by one" in caplog.text
    assert np.array_equal(found.results, one_by_one(simulator, t, w, p))


def test_one_sample_is_a_run():
    simulator, t, w, p = case(Variant(), "slalom", np.random.default_rng(6))
    found = Ensemble(simulator, NAMES).run(t[:1], w[:1], p)
    assert np.array_equal(found.results, one_by_one(simulator, t[:1], w[:1], p))
