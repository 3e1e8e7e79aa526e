"""The paper's equations to the letter, and what it concludes from them."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.contracts.places import Place, evaluate
from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice, assemble

PAPER = Variant(Choice(equations="paper"))


def right_hand_sides(
    u,
    v,
    r,
    F_rl,
    F_rr,
    phi_r,
    phi_l,
    a=0.25,
    b=0.20,
    tr=0.55,
    tf=0.45,
    m=80.0,
    I_z=3.08,
    C=5038.0,
    C_m=45.0,
    C_phi=464.0,
    C_m_phi=3.0,
    f_r=0.012,
    f_f=0.020,
    g=9.81,
):
    """u', v', ψ'', slips and loads, typed from the paper and sharing nothing with the model."""
    delta_fr = (a * r + v) / (-0.5 * tf * r + u)  # (9)
    delta_fl = (a * r + v) / (0.5 * tf * r + u)  # (10)
    lam_rr = -(-b * r + v) / (-0.5 * tr * r + u)  # (11)
    lam_rl = -(-b * r + v) / (0.5 * tr * r + u)  # (12)
    F_srr = C * lam_rr + C_phi * phi_r  # (13)
    F_srl = C * lam_rl + C_phi * phi_l  # (14)
    M_rr = -C_m * lam_rr + C_m_phi * phi_r  # (15)
    M_rl = -C_m * lam_rl + C_m_phi * phi_l  # (16)
    N_f, N_r = b * g * m / (2 * (a + b)), a * g * m / (2 * (a + b))  # (18), (19)
    D_rr = D_rl = f_r * N_r  # (17)
    D_fr = D_fl = f_f * N_f
    u_dot = v * r + (F_rl + F_rr - D_fl - D_fr - D_rl - D_rr) / m  # (20)
    v_dot = -u * r + (F_srl + F_srr - D_fl * delta_fl - D_fr * delta_fr) / m  # (21)
    r_dot = (
        0.5 * tr * (F_rl - F_rr)
        - b * (F_srl + F_srr)
        - a * (D_fl * delta_fl + D_fr * delta_fr)
        + M_rr
        - 0.5 * tf * (D_fl - D_fr)
        - 0.5 * tr * (D_rl - D_rr)
        + M_rl
    ) / I_z  # (22)
    return [u_dot, v_dot, r_dot], [lam_rl, lam_rr], [F_srl, F_srr], [delta_fl, delta_fr], r / np.hypot(u, v)


def test_equations_9_to_23_to_the_letter():
    rng = np.random.default_rng(0)
    variant = PAPER.with_effects(["camber_misalignment"])
    model = variant.model()
    for _ in range(20):
        u, v, r = rng.uniform(0.5, 2), rng.normal(0, 0.1), rng.normal(0, 0.5)
        F_rl, F_rr, phi_r, phi_l = *rng.normal(0, 20, 2), *rng.normal(0, 0.02, 2)
        sides = {"sum": phi_r + phi_l, "difference": phi_r - phi_l}
        p = variant.with_values({f"effect.camber_misalignment.{name}": angle for name, angle in sides.items()})
        w = np.array([i.start for i in model.inputs])
        w[:2] = F_rl, F_rr
        place = Place(np.array([0, 0, 0, u, v, r]), w, p.vector())
        f, mass, y = evaluate(model, place, model.f, model.mass, model.y)
        rates, slips, forces, deltas, curvature = right_hand_sides(u, v, r, F_rl, F_rr, phi_r, phi_l)
        results = dict(zip((o.name for o in model.outputs), y, strict=True))
        np.testing.assert_allclose((f / mass)[3:], rates, rtol=1e-12)
        np.testing.assert_allclose([results["slip.rl"], results["slip.rr"]], slips, rtol=1e-12)
        np.testing.assert_allclose([results["force.F_srl"], results["force.F_srr"]], forces, rtol=1e-12)
        np.testing.assert_allclose([results["caster.fl"], results["caster.fr"]], deltas, rtol=1e-12)
        # the model's curvature is finite at rest too, by the named slip speed of 0.01 m/s
        np.testing.assert_allclose(results["chair.curvature"], curvature, rtol=0.01**2 / u**2)


def manoeuvre(equations: str, kind: str, u: float, dF: float, **values):
    """The paper's steady turn or slalom (T = 4 s) at prescribed speed, from straight, 20 s."""
    simulator = Simulator(
        Variant(Choice(equations=equations)).with_values({"speed.mode": "prescribed", "speed.u": u, **values})
    )
    t = np.linspace(0, 20, 2001)
    wave = dF * (np.cos(2 * np.pi * t / 4) if kind == "slalom" else np.ones_like(t))
    return simulator.run(t, simulator.inputs(len(t), {"push.F_rl": wave, "push.F_rr": -wave}), tolerance=1e-9)


CASES = [
    ("steady turn", 0.3, 1),
    ("steady turn", 0.3, 2),
    ("steady turn", 0.5, 2),
    ("steady turn", 0.5, 5),
    ("steady turn", 1.0, 5),
    ("steady turn", 1.0, 10),
    ("steady turn", 1.5, 20),
    ("slalom", 0.3, 1),
    ("slalom", 0.3, 2),
    ("slalom", 0.5, 3),
    ("slalom", 1.0, 5),
    ("slalom", 1.0, 10),
]


@pytest.mark.parametrize(("kind", "u", "dF"), CASES)
def test_the_extension_agrees_above_walking_pace(kind, u, dF):
    """Radius and slip within 0.2 % while caster angles stay under 7°, within 1 % under 15°."""
    paper, extended = manoeuvre("paper", kind, u, dF), manoeuvre("extended", kind, u, dF)
    casters = np.degrees(np.abs([paper["caster.fl"], paper["caster.fr"]]).max())
    assert casters < 15
    bound = 0.002 if casters < 7 else 0.01
    later = slice(-400, None)  # the last period
    for name in ("chair.curvature", "slip.rl", "slip.rr"):
        one, two = paper[name][later], extended[name][later]
        assert np.abs(two - one).max() < bound * np.abs(one).max(), f"{name}, casters at {casters:.1f}°"


def test_stiffness_moves_the_radius_by_up_to_seven_per_cent():
    """Sections 6.1 and 6.2: the whole range from half to double."""
    radii = {}
    for name, reference in (("tyre.C_lambda", 5038.0), ("tyre.C_m_lambda", 45.0)):
        runs = [manoeuvre("extended", "steady turn", 1.0, 10, **{name: reference * f}) for f in (0.5, 1, 2)]
        radii[name] = [1 / run["chair.curvature"][-1] for run in runs]
        slips = [run["slip.rl"][-1] for run in runs]
        assert max(np.degrees(np.abs(slips))) < 1
        spread = abs(radii[name][2] - radii[name][0]) / radii[name][1]
        assert 0.05 < spread < 0.07
        if name == "tyre.C_lambda":  # slip inversely, roughly
            np.testing.assert_allclose(slips, [2 * slips[1], slips[1], slips[1] / 2], rtol=0.05)
        else:  # slip slightly smaller
            assert slips[0] > slips[1] > slips[2] > 0.9 * slips[0]
    assert radii["tyre.C_lambda"][0] > radii["tyre.C_lambda"][1] > radii["tyre.C_lambda"][2]
    assert radii["tyre.C_m_lambda"][0] < radii["tyre.C_m_lambda"][1] < radii["tyre.C_m_lambda"][2]


def camber(angle_deg: float) -> dict[str, float]:
    return {"effect.camber_misalignment.sum": 2 * np.radians(angle_deg)}


def test_positive_camber_tightens_the_turn_and_makes_the_slalom_drift():
    """Section 6.3."""
    radii = [1 / manoeuvre("extended", "steady turn", 1.0, 10, **camber(a))["chair.curvature"][-1] for a in (-1, 0, 1)]
    assert radii[0] > radii[1] > radii[2]
    drift = [manoeuvre("extended", "slalom", 1.0, 10, **camber(a))["chair.y"][-1] for a in (0, 0.5, 1)]
    assert drift[0] < drift[1] < drift[2]


def test_slips_in_the_slalom_are_asymmetric():
    """Section 6.1: the right wheel's mean is positive, the left wheel's negative; below 1° both."""
    run = manoeuvre("extended", "slalom", 1.0, 10)
    last = slice(-400, None)
    assert run["slip.rr"][last].mean() > 1e-5 > -1e-5 > run["slip.rl"][last].mean()
    assert np.degrees(np.abs([run["slip.rl"], run["slip.rr"]]).max()) < 1


def test_every_light_effect_can_be_put_into_the_papers_equations():
    """Off it changes nothing: the paper's steady turn is the same to rounding with all of them in the model."""
    light = [e for e in bundled().values() if e.stateless]
    models = [assemble(Choice(equations="paper"), effects) for effects in ([], light)]
    rates = []
    for model in models:
        defaults = np.array([p.default for p in model.parameters])
        start = kernel(model).functions["start"](defaults, [i.start for i in model.inputs])
        inputs = [10.0, 8.0, *(i.start for i in model.inputs[2:])]
        rates.append(np.array(kernel(model).functions["rate"](start, inputs, defaults)[0]).ravel())
    np.testing.assert_allclose(rates[1][:6], rates[0][:6], rtol=1e-12, atol=1e-12)
