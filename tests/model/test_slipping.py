"""Casters whose tyres slip: loads at the patches, the limit of a stiff tyre, and effects that casters have."""

from __future__ import annotations

import casadi as cs
import numpy as np
import pytest

from tests.model.effects.chair import MASS, A, B, G
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

TRAIL = 0.05
CASTERS = ("swivel.fl", "swivel.fr")
LAW = Variant(Choice(caster="slipping"))


@pytest.mark.parametrize(("angles", "front"), [((0.0, 0.0), 0.40), ((np.pi, -np.pi), 0.50), ((0.0, np.pi), 0.45)])
def test_the_floor_carries_the_casters_at_their_patches(angles, front):
    """0.392 kN trailing, 0.314 kN after backing up, of the 80 kg of Table 1; half of each, half the way."""
    chair = Simulator(LAW.with_values({"start.u": 0.0, "start.caster_l": angles[0], "start.caster_r": angles[1]}))
    time = np.array([0.0, 1e-3])
    result = chair.run(time, chair.inputs(2, {}))
    assert result["load.fl"][0] + result["load.fr"][0] == pytest.approx(MASS * G * B / front, rel=1e-4)
    assert front == pytest.approx(A + B - TRAIL * np.cos(angles).mean())
    assert result["load.fl"][0] + result["load.fr"][0] + result["load.rl"][0] + result["load.rr"][0] == pytest.approx(MASS * G)


def test_a_stiff_light_caster_is_one_that_does_not_slip():
    """With hardly any inertia and a stiff tyre it goes where the law without side slip sends it."""
    stiff = {"caster.C_lambda": 1e5, "caster.sigma": 1e-3, "caster.I": 1e-5, "caster.M": 0.0, "caster.d": 0.0, "caster.mu": 5.0}
    free = {"resistance.f_r": 0.0, "resistance.f_f": 0.0, "start.u": 0.6, "start.caster_l": 0.5, "start.caster_r": -0.3}
    other = Variant(Choice(caster="swivelling")).with_values({**free, "effect.caster_trail.c": TRAIL - 1e-3})
    time = np.linspace(0, 2, 401)
    push = {"push.F_rl": 3 * np.sin(3 * time), "push.F_rr": -3 * np.sin(3 * time)}
    slips, rolls = (Simulator(v) for v in (LAW.with_values({**free, **stiff}), other))
    one, two = (s.run(time, s.inputs(len(time), push), tolerance=1e-7) for s in (slips, rolls))
    for name in ("caster.fl", "caster.fr"):
        np.testing.assert_allclose(one[name], two[name], atol=0.01)
    np.testing.assert_allclose(one["chair.psi"], two["chair.psi"], atol=0.003)


def test_effects_of_casters_act_on_them_too():
    """An effect that needs casters that swing keeps this law, and adds to what it has."""
    chair = LAW.with_effects(["caster_friction", "caster_trail", "caster_inertia", "turn_slip"])
    assert chair.choice == LAW.choice
    values = {"caster.M": 0.1, "effect.caster_friction.M": 0.3, "effect.caster_trail.c": 0.02}
    model, p = chair.model(), chair.with_values(values).vector()
    x = np.zeros(model.x.numel())
    names = [n for s in model.states for n in s.names]
    x[names.index("turning_rate.fl")] = 5.0
    wanted = [model.quantities[name] for name in ("M_w", "c", "lever", "N_f")]
    read = cs.Function("read", [model.x, model.w, model.p], wanted)
    torque, trail, lever, load = (r.full().ravel() for r in read(x, [i.start for i in model.inputs], p))
    assert torque == pytest.approx([-0.4 - 0.002 * 5.0, 0.0]) and trail == pytest.approx([TRAIL + 0.02] * 2)
    assert lever == pytest.approx(trail)
    assert load.sum() == pytest.approx(MASS * G * B / (A + B - TRAIL - 0.02))
    assert Variant().with_effects(["caster_friction"]).choice.caster == "swivelling"


def test_starts_are_mirror_images():
    """A chair with the left caster turned in is the mirror image of one with the right caster turned in."""
    time = np.linspace(0, 1, 101)
    results = []
    for turned in ({"start.caster_l": 0.6, "start.caster_r": 0.1}, {"start.caster_l": -0.1, "start.caster_r": -0.6}):
        chair = Simulator(LAW.with_values({"start.u": 0.3, **turned}))
        results.append(chair.run(time, chair.inputs(len(time), {}), tolerance=1e-7))
    one, other = results
    np.testing.assert_allclose(one["chair.psi"], -other["chair.psi"], atol=1e-6)
    np.testing.assert_allclose(one["caster.fl"], -other["caster.fr"], atol=1e-6)
    assert np.abs(one["chair.psi"]).max() > 0.01
