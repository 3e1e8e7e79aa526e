"""Derivatives of whole runs against central differences of whole runs."""

from __future__ import annotations

import numpy as np
import pytest

from tests.kit import variant_with
from wheelchair_fmu.engine import cache
from wheelchair_fmu.engine.sensitivities import Sensitivities
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.engine.tangent import sensed
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant

CALIBRATED = (
    "tyre.C_lambda",
    "tyre.C_m_lambda",
    "resistance.f_r",
    "resistance.f_f",
    "chair.I_z",
    "chair.m",
    "chair.a",
    "chair.b",
    "chair.t_r",
    "start.u",
    "start.v",
    "start.psi_dot",
)
SLALOM = (1.0, lambda t: 8 + 6 * np.sin(3 * t), lambda t: 8 - 6 * np.sin(3 * t))
SPIN = (0.05, lambda t: 15 * np.sin(t), lambda t: -14 * np.sin(t))


def stateful_apart(ids):
    return [i for i in ids if not bundled()[i].needs]


@pytest.mark.parametrize(
    ("case", "motion"),
    [
        *((case, motion) for case in ("base", "swivelling") for motion in ("slalom", "spin")),
        # another model, of all effects, to compile
        *(pytest.param("effects", motion, marks=pytest.mark.nightly) for motion in ("slalom", "spin")),
    ],
)
def test_by_every_parameter(case, motion):
    ids = {"base": [], "effects": stateful_apart(bundled()), "swivelling": ["caster_friction"]}[case]
    if motion == "spin":  # hubs pass through rest with the tyre still deflected: differences there are no truth
        ids = [i for i in ids if i != "relaxation_length"]
    variant = variant_with(*ids)
    sensitivities = Sensitivities(variant)
    simulator = Simulator(variant)
    t = np.linspace(0, 3, 121)
    u, left, right = {"slalom": SLALOM, "spin": SPIN}[motion]
    w = simulator.inputs(len(t), {"push.F_rl": left(t), "push.F_rr": right(t)})
    base = variant.with_values({"start.u": u})
    names = [*CALIBRATED, *(p.name for p in base.parameters() if p.name.startswith("effect.") and p.estimated)]
    run = sensitivities.run(t, w, base.vector(), names, tolerance=1e-9)
    for k, name in enumerate(names):
        record = next(p for p in base.parameters() if p.name == name)
        value = base.values.get(name, record.default)
        # where a wheel turns round results bend so sharply that one step of a difference may be too wide, another too rough
        error = min(
            _error(run, sensitivities.rows, simulator, t, w, base, name, h * (abs(value) or 0.1), k) for h in (1e-4, 1e-5)
        )
        assert error < 2e-3, f"{name}: {error:.2g}"


def _error(run, rows, simulator, t, w, base, name, h, k):
    """How far slopes by a parameter are from central differences with the step h, beside their sizes."""
    value = base.vector()[[p.name for p in base.parameters()].index(name)]
    ends = [simulator.run(t, w, base.vector({name: value + s * h}), tolerance=1e-11).results for s in (1, -1)]
    expected = ((ends[0] - ends[1]) / (2 * h))[:, list(rows)]
    scale = np.abs(expected).max(axis=0) + 1e-3 * np.abs(expected).max() + 1e-7 / h
    return (np.abs(run.by_parameter[:, :, k] - expected) / scale).max()


def test_by_states_and_pushes():
    """Chained over the samples, the one-sample maps give the derivative of the end by an early push."""
    variant = variant_with("relaxation_length", "floor_slope")
    sensitivities, simulator = Sensitivities(variant), Simulator(variant)
    t = np.linspace(0, 2, 81)
    w = simulator.inputs(len(t), {"push.F_rl": SLALOM[1](t), "push.F_rr": SLALOM[2](t)})
    run = sensitivities.run(t, w, variant.vector(), tolerance=1e-9)
    i, h = 30, 1e-3
    change = run.push_after[i - 1][:, 0]
    change = run.transition[i] @ change + run.push_before[i][:, 0]
    for j in range(i + 1, len(t) - 1):
        change = run.transition[j] @ change
    ends = []
    for s in (1, -1):
        bumped = w.copy()
        bumped[i, 0] += s * h
        ends.append(simulator.run(t, bumped, variant.vector(), tolerance=1e-11).states[-1])
    expected = (ends[0] - ends[1]) / (2 * h)
    np.testing.assert_allclose(change, expected, rtol=1e-3, atol=1e-4 * np.abs(expected).max())


def test_the_run_itself_is_the_simulators():
    variant = variant_with("wheel_inertia")
    t = np.linspace(0, 3, 301)
    simulator = Simulator(variant)
    w = simulator.inputs(len(t), {"push.F_rl": SLALOM[1](t), "push.F_rr": SLALOM[2](t)})
    run = Sensitivities(variant).run(t, w, variant.vector())
    # The same steps, in loops over their stages instead of written out: to rounding.
    np.testing.assert_allclose(run.results, simulator.run(t, w).results, rtol=1e-11, atol=1e-12)


def test_brakes_that_a_run_records_move_it_and_its_derivatives():
    """What moves is named when the model is compiled; else it is refused, not overlooked."""
    t, by = np.linspace(0, 2, 201), ("brake.F_max",)
    simulator = Simulator(Variant())
    w = simulator.inputs(len(t), {"push.F_rl": 12.0, "push.F_rr": 12.0, "brake.rl": 0.02 * (t > 0.5)})
    p = simulator.variant.vector()
    braked = Sensitivities(Variant(), by, moving=("brake.rl",)).run(t, w, p, by)
    np.testing.assert_allclose(braked.results, simulator.run(t, w).results, rtol=1e-4, atol=1e-5)
    at = [i.name for i in simulator.model.parameters].index("brake.F_max")
    more, less = p.copy(), p.copy()
    more[at], less[at] = p[at] + 0.1, p[at] - 0.1
    rows = list(sensed(simulator.model))
    expected = (simulator.run(t, w, more).results - simulator.run(t, w, less).results)[:, rows] / 0.2
    assert np.abs(expected).max() > 1e-4
    np.testing.assert_allclose(braked.by_parameter[:, :, 0], expected, atol=1e-3 * np.abs(expected).max())
    with pytest.raises(ValueError, match=r"leave brake\.rl at rest"):
        Sensitivities(Variant(), by).run(t, w, p, by)


def test_a_riders_momentum_is_a_noisy_input_where_it_moves_and_costs_nothing_where_not():
    """By it go the frame's speed at once and the chair's later; no column is kept for it where nobody recorded it."""
    t, by = np.linspace(0, 2, 81), ("rider.scale",)
    simulator = Simulator(Variant())
    swing = 20 * np.sin(8 * t)
    w = simulator.inputs(len(t), {"push.F_rl": SLALOM[1](t), "push.F_rr": SLALOM[2](t), "rider.momentum": swing})
    p = simulator.variant.vector()
    moved = Sensitivities(Variant(), by, moving=("rider.momentum",)).run(t, w, p, by, tolerance=1e-9)
    assert moved.push_before.shape[2] == moved.by_push.shape[2] == 5
    column = [i.name for i in simulator.model.inputs].index("rider.momentum")
    assert column == 4
    sensor = [simulator.model.outputs[i].name for i in sensed(simulator.model)].index("sensor.wheel_speed_l")
    np.testing.assert_allclose(moved.by_push[:, sensor, column], -1 / 80.0, rtol=1e-6)
    i, h = 30, 1e-2
    change = moved.transition[i] @ moved.push_after[i - 1][:, column] + moved.push_before[i][:, column]
    for j in range(i + 1, len(t) - 1):
        change = moved.transition[j] @ change
    ends = []
    for s in (1, -1):
        bumped = w.copy()
        bumped[i, column] += s * h
        ends.append(simulator.run(t, bumped, p, tolerance=1e-11).states[-1])
    expected = (ends[0] - ends[1]) / (2 * h)
    np.testing.assert_allclose(change, expected, rtol=2e-3, atol=1e-3 * np.abs(expected).max())
    more, less = (simulator.run(t, w, simulator.variant.vector({"rider.scale": k}), tolerance=1e-9) for k in (1.001, 0.999))
    slope = (more["sensor.wheel_speed_l"] - less["sensor.wheel_speed_l"]) / 0.002
    np.testing.assert_allclose(moved.by_parameter[:, sensor, 0], slope, atol=1e-3 * np.abs(slope).max())
    still = simulator.inputs(len(t), {"push.F_rl": SLALOM[1](t)})
    assert Sensitivities(Variant(), by).run(t, still, p, by).by_push.shape[2] == 4


@pytest.mark.nightly  # compiles derivatives anew
def test_stages_together_are_as_one_by_one(tmp_path, monkeypatch, caplog):
    """With every width that this processor has, and by a compiler without vectors."""
    variant = variant_with("rolling_resistance_asymmetry")
    t = np.linspace(0, 3, 121)
    runs = []

    def run():
        sensitivities = Sensitivities(variant)
        w = sensitivities.simulator.inputs(len(t), {"push.F_rl": 8 + 6 * np.sin(3 * t), "push.F_rr": 8 - 6 * np.sin(3 * t)})
        runs.append(sensitivities.run(t, w, variant.vector(), sensitivities.columns))

    widths = [n for n in cache.VECTORS if n <= cache.width()]
    for width in widths:
        monkeypatch.setattr(cache, "width", lambda width=width: width)
        run()
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path))
    text_of = cache.of_stages
    monkeypatch.setattr(cache, "of_stages", lambda *given: ("#error no vectors\n", text_of(*given)[1]))
    with caplog.at_level("INFO"):
        run()
    assert "stages are evaluated one by one" in caplog.text
    for name in ("states", "by_parameter", "transition", "push_before", "push_after", "by_state", "by_push", "start"):
        alone = getattr(runs[-1], name)
        for together in runs[:-1]:
            np.testing.assert_allclose(getattr(together, name), alone, rtol=0, atol=1e-12 * np.abs(alone).max())
