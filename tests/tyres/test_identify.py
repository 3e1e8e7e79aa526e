"""What is identified, against tyres whose laws are known, and against the paper's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.errors import Failure
from wheelchair_fmu.model.effects import inflation_pressure, load_sensitivity
from wheelchair_fmu.model.tyre.common import PARAMETERS
from wheelchair_fmu.tyres import identify, read
from wheelchair_fmu.tyres.half_difference import corrected, pairs
from wheelchair_fmu.tyres.identify import dugoff_off
from wheelchair_fmu.tyres.magic_formula import FORCE, TORQUE
from wheelchair_fmu.tyres.records import CAMBER, SLIP

from .rig import LEANS, SLIPS, Tyre

ROTATING_DISC = Path(__file__).parents[2] / "examples" / "rotating-disc.csv"
DEFAULT = {p.name: p.default for p in PARAMETERS}


@pytest.fixture(scope="module")
def disc():
    return identify(read(ROTATING_DISC).sweeps)


def within(estimate, truth, sigmas=3.5):
    assert abs(estimate.value - truth) < sigmas * estimate.se, (estimate, truth)


def test_the_half_difference_cancels_any_even_part_and_keeps_the_odd_one():
    x = np.radians(np.r_[-SLIPS[::-1], 0, SLIPS])
    curve = corrected(pairs(x), 9.0 + 3 * np.cos(40 * x) + 100 * np.tan(x))
    assert np.allclose(curve.value, 100 * np.tan(np.radians(SLIPS)), atol=1e-12)


def test_the_half_sums_tell_the_noise_and_the_curvature_force():
    sigmas, offsets = [], []
    rig = Tyre()
    for _ in range(40):
        sweep = rig.sweep()
        curve = corrected(pairs(sweep.angle), sweep.force)
        sigmas.append(curve.sigma)
        offsets.append((curve.offset - rig.curvature) / curve.offset_se)
    assert np.mean(np.square(sigmas)) ** 0.5 == pytest.approx(0.6 / np.sqrt(2), rel=0.1)
    assert np.std(offsets) < 1.6


def test_a_known_tyre_is_found_again():
    rig = Tyre()
    found = identify([rig.sweep(), rig.sweep(CAMBER)]).conditions[0]
    x = np.radians(np.linspace(0, 5, 50))
    for channel, truth, sigma in zip((FORCE, TORQUE), rig.curves(SLIP, x), rig.noise, strict=True):
        law = found.magic(SLIP, channel)
        assert np.abs(law(x) - truth).max() < 2 * sigma
        assert law.rms < 1.5 * sigma
    within(found.K(SLIP, FORCE), 5040)
    within(found.K(SLIP, TORQUE), -44.88)
    within(found.K(CAMBER, FORCE), 464)
    within(found.K(CAMBER, TORQUE), 3)
    within(found.magic(SLIP, FORCE).K, 5040)


def test_intervals_hold_the_truth_about_as_often_as_they_say():
    rig, hits = Tyre(), 0
    for _ in range(60):
        found = identify([rig.sweep()]).conditions[0]
        for channel, truth in ((FORCE, 5040), (TORQUE, -44.88)):
            low, high = found.K(SLIP, channel).interval
            hits += low <= truth <= high
    assert hits >= 108  # of 120, where 95 % are 114


def test_without_noise_the_coefficients_themselves_come_back():
    rig = Tyre(noise=(0.0, 0.0))
    law = identify([rig.sweep(angles=np.linspace(0.25, 15, 40))]).conditions[0].magic(SLIP, FORCE)
    assert [law.B.value, law.C.value, law.D.value, law.E.value] == pytest.approx([8.4, 1.5, 400, 0], rel=2e-2, abs=2e-2)
    assert law.untold == ()


def test_a_mirrored_rig_gives_the_same_laws():
    sweep = Tyre().sweep()
    mirrored = type(sweep)(sweep.condition, sweep.kind, -sweep.angle, -sweep.force, -sweep.torque)
    a, b = (identify([s]).conditions[0] for s in (sweep, mirrored))
    assert a.K(SLIP, FORCE).value == pytest.approx(b.K(SLIP, FORCE).value, rel=1e-9)
    assert a.magic(SLIP, TORQUE).D.value == pytest.approx(b.magic(SLIP, TORQUE).D.value, rel=1e-6)


def test_the_exponents_of_load_and_pressure_are_found_again():
    rig = Tyre()
    sweeps = [rig.sweep(kind, p, N) for p, N in ((4, 400), (2, 400), (4, 600), (3, 200)) for kind in (SLIP, CAMBER)]
    laws = identify(sweeps).across["T"].laws
    within(laws["C_lambda"].K, 5040)
    within(laws["C_lambda"].exponents["pressure"], 0.62)
    within(laws["C_lambda"].exponents["load"], 0.75)
    within(laws["C_m_lambda"].exponents["pressure"], -0.64)
    within(laws["C_m_lambda"].exponents["load"], 1.0)
    within(laws["C_phi"].exponents["load"], 1.0)


# ── the rotating-disc file ──


def test_the_whole_file_is_fitted(disc):
    assert len(disc.conditions) == 8


def test_the_reference_condition_is_table_1(disc):
    law = disc.across["A"].laws
    within(law["C_lambda"].K, DEFAULT["tyre.C_lambda"])
    within(law["C_m_lambda"].K, DEFAULT["tyre.C_m_lambda"])
    within(law["C_phi"].K, DEFAULT["tyre.C_phi"])


def test_the_default_pressure_exponents_are_those_of_tyre_a(disc):
    laws = disc.across["A"].laws
    within(laws["C_lambda"].exponents["pressure"], DEFAULT["tyre.pressure_F"], 2)
    within(laws["C_m_lambda"].exponents["pressure"], DEFAULT["tyre.pressure_M"], 2)


def test_the_effects_give_the_stiffnesses_that_were_measured(disc):
    """`inflation_pressure` at −2 bar with the default exponents, `load_sensitivity` at 600 N with the fitted one."""
    scale = {c.to: c.law for c in inflation_pressure.EFFECT.contributions}
    at = {(f.condition.tyre, f.condition.pressure, f.condition.load): f for f in disc.conditions if f.condition.speed > 1}
    soft, reference, heavy = (at["A", p, N] for p, N in ((2, 400), (4, 400), (4, 600)))
    for to, name, channel in (("q_F", "tyre.pressure_F", FORCE), ("q_M", "tyre.pressure_M", TORQUE)):
        factor = float(scale[to](-2.0, 4.0, DEFAULT[name]))
        measured = soft.magic(SLIP, channel).K.value / reference.magic(SLIP, channel).K.value
        assert factor == pytest.approx(measured, rel=0.05)
    scale = {c.to: c.law for c in load_sensitivity.EFFECT.contributions}
    for to, name, channel in (("q_F", "C_lambda", FORCE), ("q_M", "C_m_lambda", TORQUE)):
        exponent = disc.across["A"].laws[name].exponents["load"].value
        measured = heavy.K(SLIP, channel).value / reference.K(SLIP, channel).value
        assert float(scale[to](exponent, 600.0, 400.0)) == pytest.approx(measured, rel=0.02)
    assert 0 < disc.across["A"].laws["C_lambda"].exponents["load"].value < 1  # Fig. 7.1: forces grow less than the load


def test_what_the_paper_says_of_these_tyres(disc):
    at = {(f.condition.tyre, f.condition.pressure, f.condition.load): f for f in disc.conditions if f.condition.speed > 1}

    def slope(kind, channel, *condition):
        return abs(at[condition].K(kind, channel).value)

    assert slope(SLIP, FORCE, "A", 4, 400) > slope(SLIP, FORCE, "B", 4, 400)  # Fig. 4.1
    assert slope(CAMBER, FORCE, "A", 4, 400) > slope(CAMBER, FORCE, "B", 4, 400)  # Fig. 4.3
    for tyre in "AB":
        assert slope(SLIP, FORCE, tyre, 2, 400) < 0.8 * slope(SLIP, FORCE, tyre, 4, 400)  # Fig. 6.1
        assert slope(SLIP, TORQUE, tyre, 2, 400) > 1.2 * slope(SLIP, TORQUE, tyre, 4, 400)  # Fig. 6.2
        exponents = disc.across[tyre].speed
        assert abs(exponents["C_lambda"].value) < 3 * exponents["C_lambda"].se  # Fig. 5
    camber = {t: disc.across[t].laws["C_phi"].exponents["pressure"] for t in "AB"}
    assert abs(camber["A"].value) < 2 * camber["A"].se and camber["B"].value < -3 * camber["B"].se  # Fig. 6.3


def test_dugoff_follows_the_force_but_not_the_torque_beyond_three_degrees(disc):
    """Section 4: the Magic Formula fits both; Dugoff's constant trail cannot follow a torque that levels off."""
    for fit in disc.conditions:
        assert dugoff_off(fit, FORCE) == ()
        assert dugoff_off(fit, TORQUE)[-1][1] == pytest.approx(np.radians(5))
        assert fit.dugoff.rms_torque > 8 * fit.magic(SLIP, TORQUE).rms
        assert fit.magic(SLIP, FORCE).rms < 1.0 and fit.magic(SLIP, TORQUE).rms < 0.05


def test_the_linear_law_ends_where_it_is_said_to(disc):
    for fit in disc.conditions:
        curve = fit.fits[SLIP, FORCE]
        law, end = curve.magic, curve.linear_to
        error = abs(law.K.value * end - law(np.array([end]))[0]) / law(np.array([end]))[0]
        assert curve.ends and error == pytest.approx(disc.tolerance, rel=0.02)


# ── what data cannot support ──


def test_five_points_support_a_slope_and_no_more():
    found = identify([Tyre().sweep(angles=[2.0, 5.0])]).conditions[0]
    assert found.magic(SLIP, FORCE) is None and found.dugoff is None
    assert found.K(SLIP, FORCE).value > 3000
    assert "2 angles measured with both signs cannot tell how it bends, nor" in found.warnings[0]


def test_slips_below_half_a_degree_support_a_slope_and_no_more():
    found = identify([Tyre().sweep(angles=np.linspace(0.05, 0.5, 10))]).conditions[0]
    assert found.magic(SLIP, FORCE) is None and found.dugoff is None
    within(found.K(SLIP, FORCE), 5040, 4)
    assert "no angle beyond 0.5°" in found.warnings[0]


def test_one_sign_only_is_refused_because_the_curvature_force_stays_in():
    sweep = Tyre().sweep()
    right = sweep.angle > 0
    half = type(sweep)(sweep.condition, sweep.kind, sweep.angle[right], sweep.force[right], sweep.torque[right])
    with pytest.raises(Failure, match="all angles are positive; measure every angle with both signs"):
        identify([half])


@pytest.mark.parametrize(
    ("force", "said"),
    [
        (lambda a: 0 * a, "the force is the same at both signs of every angle"),
        (lambda a: 3 + a**2, "the force is the same at both signs of every angle"),
        (lambda a: 50 * a**3, "the slope is not told from zero"),
        (lambda a: 60 * a, "bends less than the noise"),
    ],
)
def test_forces_of_odd_shapes_are_told_and_do_not_stop_the_rest(force, said):
    sweep = Tyre().sweep()
    odd = type(sweep)(sweep.condition, sweep.kind, sweep.angle, force(np.degrees(sweep.angle)), sweep.torque)
    found = identify([odd]).conditions[0]
    assert any(said in w for w in found.warnings)
    assert found.dugoff is None and found.magic(SLIP, FORCE) is None and found.magic(SLIP, TORQUE) is not None


def test_a_force_that_falls_again_beyond_its_peak_is_fitted():
    sweep = Tyre().sweep()
    x = np.degrees(sweep.angle)
    peaked = type(sweep)(sweep.condition, sweep.kind, sweep.angle, 300 * x / (1 + (x / 2) ** 2), sweep.torque)
    found = identify([peaked]).conditions[0]
    assert found.magic(SLIP, FORCE).rms < 10 and found.K(SLIP, FORCE).value == pytest.approx(np.degrees(300), rel=0.05)


def test_torques_that_were_not_measured_are_named():
    sweep = Tyre().sweep()
    found = identify([type(sweep)(sweep.condition, sweep.kind, sweep.angle, sweep.force, sweep.torque * np.nan)])
    assert found.conditions[0].dugoff.c_p is None
    assert "side slip: no torque was measured; its laws are left out" in found.conditions[0].warnings


def test_an_angle_without_its_partner_is_left_out_and_named():
    sweep = Tyre().sweep()
    keep = np.arange(len(sweep.angle)) != len(sweep.angle) - 1
    short = type(sweep)(sweep.condition, sweep.kind, sweep.angle[keep], sweep.force[keep], sweep.torque[keep])
    found = identify([short]).conditions[0]
    assert "5° measured with one sign only" in found.warnings[0]
    assert len(found.fits[SLIP, FORCE].curve.angle) == len(SLIPS) - 1


def test_nothing_but_noise_gives_no_slope():
    rng = np.random.default_rng(1)
    sweep = Tyre().sweep(CAMBER)
    noise = type(sweep)(sweep.condition, sweep.kind, sweep.angle, rng.normal(size=len(sweep.angle)), sweep.torque)
    found = identify([noise, Tyre().sweep()]).conditions[0]
    assert any("camber force: the slope is not told from zero" in w for w in found.warnings)


def test_forces_of_other_axes_are_recognised():
    sweep = Tyre().sweep()
    turned = type(sweep)(sweep.condition, sweep.kind, sweep.angle, -sweep.force, -sweep.torque)
    found = identify([turned]).conditions[0]
    assert any("--axes iso" in w for w in found.warnings) and found.dugoff is None


def test_a_straight_camber_curve_is_no_fault():
    found = identify([Tyre().sweep(), Tyre().sweep(CAMBER, angles=LEANS)]).conditions[0]
    assert found.warnings == () and found.K(CAMBER, FORCE).value == pytest.approx(464, rel=0.05)
