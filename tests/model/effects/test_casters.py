"""Casters with trail, inertia and friction, each against a truth its file does not contain."""

from __future__ import annotations

import numpy as np
import pytest

from tests.model.effects.chair import I_Z, MASS, SMOOTH, T_F, T_R, TOP, A, run, snapshot

TRAIL = 0.05
# The law's own 1 mm and the rest, longer than the lever that is stated: there is one trail, and it is this.
REAL = {**SMOOTH, "caster.trail": 0.03, "effect.caster_trail.c": TRAIL - 1e-3}
SWINGING = {"start.u": 0.8, "start.v": 0.1, "start.psi_dot": -0.9}
ANGLES = {"swivel.fl": 0.7, "swivel.fr": -0.4}


def power(now: dict) -> float:
    """Rate of the chair's kinetic energy."""
    return now["m"] * (now["u"] * now["u'"] + now["v"] * now["v'"]) + now["I_z"] * now["psi_dot"] * now["psi_dot'"]


@pytest.mark.effect("caster_trail")
@pytest.mark.parametrize("u", [1.0, -0.4])
def test_a_turned_caster_swings_back_by_its_trail(u):
    """c δ' = −u sin δ has the solution tan(δ/2) = tan(δ₀/2) exp(−u t/c); backing up, the caster swings round."""
    result = run({**REAL, "start.u": u}, T=0.3, n=31, states={"swivel.fl": 1.0, "swivel.fr": -2.0})
    for name, start in (("caster.fl", 1.0), ("caster.fr", -2.0)):
        expected = np.tan(start / 2) * np.exp(-u * result.time / TRAIL)
        np.testing.assert_allclose(np.tan(result[name] / 2), expected, rtol=1e-6)


@pytest.mark.effect("caster_inertia")
def test_on_the_spot_the_casters_count_with_their_inertia():
    """(I_z + 2 I) ψ'' = t_r F: each patch rolls round the CM, so its lateral force has no moment about it."""
    I, F, T_filter = 0.05, 2.0, 0.02  # noqa: E741
    spin, expected = 0.5, T_R * F / (I_Z + 2 * I)
    pivots = np.array([-T_F / 2, T_F / 2])
    angles = np.arctan2(A, -pivots) - np.arcsin(TRAIL / np.hypot(A, T_F / 2))  # the wheel's axle points at the CM
    smoothed = spin - T_filter * expected  # what the filter says when the spin has grown steadily
    now = snapshot(
        {**TOP, **REAL, "start.psi_dot": spin, "effect.caster_inertia.I": I, "effect.caster_inertia.filter": T_filter},
        {"push.F_rl": F, "push.F_rr": -F},
        {
            **dict(zip(("swivel.fl", "swivel.fr"), angles, strict=True)),
            **dict.fromkeys(("effect.caster_inertia.smoothed_rate.fl", "effect.caster_inertia.smoothed_rate.fr"), smoothed),
        },
    )
    np.testing.assert_allclose(now["swivel_rate"], 0, atol=1e-12)
    assert now["psi_dot'"] == pytest.approx(expected, rel=1e-9)


@pytest.mark.effect("caster_inertia")
def test_what_the_casters_rotation_gains_the_chair_loses():
    """Power = −d/dt Σ ½ I (δ' + ψ')² in any motion: swivel inertia keeps energy."""
    I = 0.03  # noqa: E741
    smoothed = {"effect.caster_inertia.smoothed_rate.fl": 2.0, "effect.caster_inertia.smoothed_rate.fr": -5.0}
    on, off = (
        snapshot({**REAL, **SWINGING, "effect.caster_inertia.I": value}, states={**ANGLES, **smoothed}) for value in (I, 0.0)
    )
    turning = on["swivel_rate"] + on["psi_dot"]
    gained = sum(I * rate * on[f"{name}'"] for rate, name in zip(turning, smoothed, strict=True))
    assert abs(gained) > 1
    assert power(on) - power(off) == pytest.approx(-gained, rel=1e-9)


@pytest.mark.effect("caster_friction")
def test_the_chair_loses_what_the_bearings_rub():
    """Power = −Σ M |δ'|, and that from a torque on the caster and its reaction on the chair."""
    M = 0.2
    on, off = (snapshot({**REAL, **SWINGING, "effect.caster_friction.M": value}, states=ANGLES) for value in (M, 0.0))
    assert np.all(np.abs(on["swivel_rate"]) > 1)
    assert power(on) - power(off) == pytest.approx(-M * np.abs(on["swivel_rate"]).sum(), rel=1e-9)


@pytest.mark.effect("caster_friction")
def test_caster_friction_pushes_the_swinging_caster_with_its_lever():
    """Casters straight while the chair begins to turn: they swing to the right, and their patches are pushed to the left.

    Ideal casters, trailing at once, are pushed with the lever that is stated, 50 mm, real ones with that by which they swing,
    be it longer or shorter; halfway between 1 and 20 mm it is halfway between 50 and 20 mm.
    """
    for trail, lever in ((0.0, 0.05), (0.0095, 0.035), (0.019, 0.02), (0.029, 0.03), (0.099, 0.1)):
        now = snapshot(
            {**SMOOTH, "effect.caster_friction.M": 0.2, "effect.caster_trail.c": trail, "start.psi_dot": 0.5},
            states={"swivel.fl": 0.0, "swivel.fr": 0.0},
        )
        np.testing.assert_allclose(now["swivel_rate"], 0.5 * (A - trail - 1e-3) / (trail + 1e-3))  # v_y = a ψ' at the pivot
        np.testing.assert_allclose(now["F_yf"], -0.2 / lever, rtol=1e-6)


@pytest.mark.effect("caster_friction")
@pytest.mark.parametrize("u", [0.8, 0.0, -0.6])
def test_bearings_that_rub_never_drive_the_chair(u):
    """Whatever the trail: the force at the patch has the lever by which the caster swings."""
    for trail in (0.0, 0.1):
        result = run(
            {
                **SMOOTH,
                **SWINGING,
                "tyre.C_m_lambda": 0.0,
                "start.u": u,
                "effect.caster_trail.c": trail,
                "effect.caster_friction.M": 0.5,
            },
            T=3.0,
            states={"swivel.fl": 1.0, "swivel.fr": -0.5},
        )
        speeds = (result[f"chair.{name}"] for name in ("u", "v", "psi_dot"))
        energy = sum(0.5 * inertia * speed**2 for inertia, speed in zip((MASS, MASS, I_Z), speeds, strict=True))
        assert np.diff(energy).max() < 1e-9 * energy[0]
        assert energy[-1] < 0.999 * energy[0]


@pytest.mark.parametrize(("left", "right"), [(-10.4, -10.0), (-10.0, -10.0)])
def test_casters_swing_round_when_the_chair_backs_up_from_rest(left, right):
    """Pulled evenly too, where a caster exactly in line would have no side to fall to; then both fall outward."""
    result = run({"effect.caster_friction.M": 0.0, "start.u": 0.0}, {"push.F_rl": left, "push.F_rr": right}, T=5, n=501)
    assert np.abs(result["chair.u"][-1]) > 0.3
    for name in ("caster.fl", "caster.fr"):
        assert np.abs(result[name][0]) < 0.01
        assert np.abs(np.abs(result[name][-1]) - np.pi) < 0.3
    assert np.isfinite(result.results).all()
    if left == right:
        for name in ("chair.y", "chair.psi"):
            np.testing.assert_allclose(result[name], 0, atol=1e-9)


@pytest.mark.parametrize("u", [1.0, -0.5])
@pytest.mark.parametrize("mode", ["free", "prescribed"])
def test_casters_trail_the_speed_that_holds_at_the_start(u, mode):
    """Half a turn apart forward and backward, and on a circle the left less than the right, each at its own pivot's speed."""
    held = {"speed.mode": mode, "start.u": u if mode == "free" else 3.0, "speed.u": u if mode == "prescribed" else 3.0}
    now = snapshot({"effect.caster_friction.M": 0.0, **held, "start.psi_dot": 0.4})
    pivots = np.array([u + 0.4 * T_F / 2 + 0.4j * A, u - 0.4 * T_F / 2 + 0.4j * A])  # velocity, forward and to the right
    np.testing.assert_allclose(now["delta"], np.angle(pivots), atol=1e-3)


def test_a_chair_that_is_all_but_at_rest_has_its_casters_behind():
    """A start of v or ψ' that is known to a thousandth must not turn them; mirrored, the other way."""
    right = snapshot({"effect.caster_friction.M": 0.0, "start.u": 0.0, "start.v": 2e-4, "start.psi_dot": 1e-3})
    left = snapshot({"effect.caster_friction.M": 0.0, "start.u": 0.0, "start.v": -2e-4, "start.psi_dot": -1e-3})
    assert np.abs(right["delta"]).max() < 0.05
    np.testing.assert_allclose(right["delta"], -left["delta"][::-1], rtol=1e-12)
