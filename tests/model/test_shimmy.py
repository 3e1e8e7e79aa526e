"""Casters whose tyres slip: when they shimmy, against the limits in closed form of a wheel on a trail behind a steady pivot.

With the pivot at a speed u straight ahead, δ' = Ω, I Ω' = −d Ω − c C z and σ z' = u δ + c Ω − u z, so

    s³ + (d/I + u/σ) s² + (d u + c² C)/(I σ) s + c C u/(I σ) = 0

whose roots are all to the left, by Routh, where (d/σ) u² + (d²/I − C c (1 − c/σ)) u + d c² C/I > 0. A caster whose tyre's σ is
shorter than its trail never shimmies; else little damping leaves a range of speeds in which it does. A bearing's dry friction M
damps small swings more than large ones, as 4 M/(π ω A) of their amplitude A does: it keeps those quiet which that suffices for.

Without damping, and rolled slowly beside σω with ω² = c² C/(I σ), s = i ω + ε gives ε = u (1/c − 1/σ)/2 to first order: a
swing grows by so much for each metre, whatever stiffness and inertia are. It is the classical condition c > σ of a trailing
wheel on a string, for a patch without length.

Kauzlarich, Bruning and Thacker (1984, 2000) describe both for wheelchairs; their own formula is not held against this one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from benchmarks.independent.chair import Chair as Independent
from benchmarks.independent.chair import Start, simulate
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.handling.linearize import linearize
from wheelchair_fmu.handling.manoeuvres import TOP_SPEED
from wheelchair_fmu.handling.trim import Chair, trim
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

TRAIL, SIGMA, STIFFNESS, INERTIA, DAMPING = 0.05, 0.1, 2500.0, 0.01, 0.25
STEADY = {"chair.m": 1000.0, "chair.I_z": 1000.0}  # a pivot that hardly moves aside
SMOOTH = {"resistance.f_r": 0.0, "resistance.f_f": 0.0, "caster.M": 0.0, "caster.mu": 5.0}
QUIET = {"regularisation.carcass": 1e-4, "regularisation.carcass_speed": 1e-3}  # hardly any damping of a carcass
CASTERS = {"caster.trail": TRAIL, "caster.sigma": SIGMA, "caster.C_lambda": STIFFNESS, "caster.I": INERTIA, "caster.d": DAMPING}


def variant(**values: float) -> Variant:
    return Variant(Choice(caster="slipping")).with_values({**SMOOTH, **CASTERS, **values})


def roots(u: float, sigma: float = SIGMA, d: float = DAMPING) -> np.ndarray:
    c, C, I = TRAIL, STIFFNESS, INERTIA  # noqa: E741
    return np.roots([1, d / I + u / sigma, (d * u + c * c * C) / (I * sigma), c * C * u / (I * sigma)])


def limits(sigma: float = SIGMA, d: float = DAMPING) -> np.ndarray:
    """Speeds between which they shimmy."""
    c, C, I = TRAIL, STIFFNESS, INERTIA  # noqa: E741
    return np.sort(np.roots([d / sigma, d * d / I - C * c * (1 - c / sigma), d * c * c * C / I]))


def critical_damping(u: float) -> float:
    """With less than this d of a bearing, casters shimmy at u."""
    c, C, I = TRAIL, STIFFNESS, INERTIA  # noqa: E741
    return float(np.roots([u / I, u * u / SIGMA + c * c * C / I, -C * c * (1 - c / SIGMA) * u]).max())


def modes(u: float, **values: float) -> np.ndarray:
    return linearize(trim(Chair(variant(**values)), u, 0.0)).eigenvalues


def eigenvalues(u: float, **values: float) -> np.ndarray:
    return modes(u, **{**STEADY, **values})


def fastest_growth(u: float, **values: float) -> float:
    """Of the modes that swing: what the chair itself does is slow and dies out."""
    found = eigenvalues(u, **values)
    return float(max(found[np.abs(found.imag) > 1].real, default=-np.inf))


@pytest.mark.parametrize("u", [0.8, 2.0, 6.0, 15.0])
def test_small_motions_of_a_caster_are_those_of_a_wheel_on_a_trail(u):
    found = eigenvalues(u)
    for root in roots(u):
        against, alike = np.sort(np.abs(found - root))[:2] / abs(root)
        assert against < 1e-5  # casters that swing against each other move no pivot
        assert alike < 0.03  # those that swing alike shake even a heavy chair


def test_casters_shimmy_between_two_speeds():
    low, high = limits()
    assert 3 < low < 4 and 18 < high < 20
    for speed, beyond in ((low, 1.03), (high, 1 / 1.03)):
        assert fastest_growth(speed / beyond) < 0 < fastest_growth(speed * beyond)


def against_each_other(u: float, sigma: float, d: float) -> complex:
    """The swing of both casters against each other, which moves no pivot, of the usual chair."""
    found = modes(u, **{"caster.sigma": sigma, "caster.d": d})
    expected = roots(u, sigma, d)
    return complex(found[np.argmin(np.abs(found - expected[np.argmax(expected.imag)]))])


# the upper one of the others is beyond what a chair is trimmed at
LIMITS = [(SIGMA, DAMPING, 0), (SIGMA, DAMPING, 1), (SIGMA, 0.1, 0), (0.07, 0.1, 0), (0.2, 0.4, 0)]


@pytest.mark.parametrize(("sigma", "d", "which"), LIMITS)
def test_critical_speeds_are_where_the_swing_neither_grows_nor_dies_out(sigma, d, which):
    """The eigenvalue of the linearised chair crosses the imaginary axis there, at the frequency that the condition has."""
    speed = limits(sigma, d)[which]
    found = brentq(lambda u: against_each_other(u, sigma, d).real, 0.8 * speed, min(1.25 * speed, TOP_SPEED), xtol=1e-6)
    assert found == pytest.approx(speed, rel=1e-3)
    omega = np.sqrt((d * speed + TRAIL**2 * STIFFNESS) / (INERTIA * sigma))  # the cubic above, where s is imaginary
    assert against_each_other(found, sigma, d).imag == pytest.approx(omega, rel=1e-3)


def test_casters_with_a_trail_longer_than_the_relaxation_length_never_shimmy():
    for u in (0.5, 3.0, 10.0, 19.0):
        for d in (0.0, DAMPING):
            assert fastest_growth(u, **{"caster.sigma": 0.8 * TRAIL, "caster.d": d}) < 0


@pytest.mark.parametrize(("stiffness", "inertia"), [(2500.0, 0.01), (10000.0, 0.01), (2500.0, 0.003)])
@pytest.mark.parametrize("sigma", [0.03, TRAIL, 0.15])
def test_an_undamped_swing_grows_by_the_metre(sigma, stiffness, inertia):
    """Casters that swing against each other move no pivot; so do those of a chair that is heavy beside C/ω²."""
    omega = np.sqrt(TRAIL**2 * stiffness / (inertia * sigma))
    u = 0.03 * sigma * omega
    values = {"caster.sigma": sigma, "caster.C_lambda": stiffness, "caster.I": inertia, "caster.d": 0.0}
    found = eigenvalues(u, **values, **QUIET)
    against = found[np.argmin(np.abs(found - 1j * omega))]
    per_metre = (1 / TRAIL - 1 / sigma) / 2
    assert against.real / u == pytest.approx(per_metre, abs=0.02 * (1 / TRAIL + 1 / sigma))
    assert against.imag == pytest.approx(omega, rel=0.01)


@pytest.mark.parametrize("sigma", [0.07, 0.15])
def test_the_second_implementation_s_swing_grows_as_fast(sigma):
    """Bristles in place of the string, Runge-Kutta in place of eigenvalues: casters knocked against each other at 3 m/s."""
    u, knock = 3.0, 1e-4
    chair = Independent(m=1e3, I_z=1e3, f_r=0.0, f_f=0.0, trail=TRAIL, I_swivel=INERTIA, swivel_dry=0.0, swivel_viscous=0.0)
    chair = replace(chair, C_caster=STIFFNESS, sigma_caster=sigma)
    nothing = np.zeros(401)
    out = simulate(chair, nothing, nothing, Start(u=u, swivel_r=knock, swivel_l=-knock), interval=1e-3, steps=5)
    swing = np.abs(out["swivel_r"])
    peaks = np.flatnonzero((swing[1:-1] > swing[:-2]) & (swing[1:-1] > swing[2:])) + 1
    peaks = peaks[peaks > 50]
    growth = np.polyfit(peaks * 1e-3, np.log(swing[peaks]), 1)[0]
    expected = roots(u, sigma, 0.0).real.max()
    assert expected > 1 and growth == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize(("u", "grows"), [(2.5, False), (5.0, True)])
def test_a_knock_dies_out_below_the_critical_speed_and_grows_to_a_bounded_swing_above(u, grows):
    knocked = {"start.u": u, "start.caster_l": 0.005, "start.caster_r": -0.002, "caster.mu": 0.5}
    chair = Simulator(variant(**knocked))
    time = np.linspace(0, 4, 2001)
    result = chair.run(time, chair.inputs(len(time), {}), tolerance=1e-7)
    swing = [np.ptp(result["caster.fl"][(time > a) & (time < a + 0.5)]) for a in (0.0, 3.0)]
    if grows:
        assert swing[1] > 5 * swing[0] and swing[1] < np.pi  # friction bounds the side force, and so the swing
    else:
        assert swing[1] < 0.05 * swing[0]


@pytest.mark.parametrize(("times", "grows"), [(0.7, False), (2.0, True)])
def test_dry_friction_keeps_those_swings_quiet_that_it_damps_enough(times, grows):
    u, M = 5.0, 0.1
    d = critical_damping(u)
    omega = np.sqrt((d * u + TRAIL**2 * STIFFNESS) / (INERTIA * SIGMA))  # of the cubic above where it is about to swing
    amplitude = 4 * M / (np.pi * omega * d)
    knocked = {"start.u": u, "start.caster_l": times * amplitude, "start.caster_r": -times * amplitude}
    rubbing = {"caster.M": M, "caster.d": 0.0, "regularisation.swivel_rate": 0.002}
    chair = Simulator(variant(**{**STEADY, **knocked, **rubbing}))
    time = np.linspace(0, 0.5, 1001)
    swing = chair.run(time, chair.inputs(len(time), {}), tolerance=1e-7)["caster.fl"]
    last = np.ptp(swing[time > 0.4]) / 2
    assert last > 10 * amplitude if grows else last < 0.1 * amplitude
