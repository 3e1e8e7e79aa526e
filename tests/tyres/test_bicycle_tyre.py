"""A real bicycle tyre (VeTyT, Dell'Orto et al. 2024), read where it lies: plausible shapes, and slopes that fits must find.

Its Magic Formula 89 coefficients were fitted by others to measurements; their table of forces goes the way of rig data here.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.tyres import identify, read
from wheelchair_fmu.tyres.magic_formula import DEVIATION, FORCE, SPREAD, TORQUE
from wheelchair_fmu.tyres.records import SLIP

ROOT = Path(__file__).resolve().parents[2]
VETYT = ROOT.parent / "shared" / "measurements" / "real" / "vetyt"
HEADER = "pressure [kPa],load [N],camber_angle [deg],slip_angle [deg],lateral_force [N],yaw_torque [N.m]"

pytestmark = pytest.mark.skipif(not VETYT.is_dir(), reason="the bicycle tyre's coefficients are not on this machine")


@pytest.fixture(scope="module")
def bicycle(tmp_path_factory):
    table = (VETYT / "mf89_evaluated_table.csv").read_text().partition("\n")[2]
    path = tmp_path_factory.mktemp("vetyt") / "bicycle.csv"
    path.write_text(f"{HEADER}\n{table}")
    return identify(read(path).sweeps)


@pytest.fixture(scope="module")
def disc():
    return identify(read(ROOT / "examples" / "rotating-disc.csv").sweeps)


def reference(found):
    return next(f for f in found.conditions if (f.condition.pressure, f.condition.load) == pytest.approx((4, 400)))


def test_the_slopes_are_those_of_the_closed_form(bicycle):
    with (VETYT / "slopes_summary.csv").open() as file:
        truths = list(csv.DictReader(file))
    for truth in truths:
        at = (float(truth["pressure_kPa"]) / 100, float(truth["Fz_N"]))
        fit = next(f for f in bicycle.conditions if (f.condition.pressure, f.condition.load) == pytest.approx(at))
        assert np.radians(fit.K(SLIP, FORCE).value) == pytest.approx(float(truth["C_alpha_N_per_deg"]), rel=0.005)
        assert np.radians(fit.K(SLIP, TORQUE).value) == pytest.approx(float(truth["C_mz_Nm_per_deg"]), rel=0.04)
    assert len(truths) == len(bicycle.conditions) == 12


def test_the_priors_of_the_shapes_hold_a_real_tyre(bicycle):
    """What a rig that stops at 5° falls back on: C, E and the peak of the bicycle tyre lie within two deviations."""
    for fit in bicycle.conditions:
        for channel, C in ((FORCE, 1.3), (TORQUE, 2.0)):
            law = fit.magic(SLIP, channel)
            assert abs(np.log(law.C.value / C)) < 2 * DEVIATION["C"]
            assert abs(law.E.value) < 2 * DEVIATION["E"]
            assert abs(np.log(abs(law.D.value) / (1.2 * fit.fits[SLIP, channel].curve.largest))) < SPREAD


def test_wheelchair_tyres_look_like_the_bicycle_tyre_as_in_figure_4(bicycle, disc):
    """Tyre A's force is close to the bicycle's; the bicycle's torque is steeper at the origin and levels off sooner."""
    real, ours = reference(bicycle), reference(disc)
    x = np.radians(5.0)
    forces = [fit.magic(SLIP, FORCE)(np.array([x]))[0] for fit in (real, ours)]
    assert forces[1] == pytest.approx(forces[0], rel=0.1)
    assert 0.8 < ours.K(SLIP, FORCE).value / real.K(SLIP, FORCE).value < 1.0
    assert real.K(SLIP, TORQUE).value < 1.5 * ours.K(SLIP, TORQUE).value  # both negative
    slips = np.radians(np.linspace(0.1, 5, 200))
    peaks = [slips[np.argmax(np.abs(fit.magic(SLIP, TORQUE)(slips)))] for fit in (real, ours)]
    assert peaks[0] < 0.75 * peaks[1]


def test_no_constant_trail_follows_the_real_torque_either(bicycle):
    for fit in bicycle.conditions:
        assert fit.dugoff.rms_force < 0.03 * fit.fits[SLIP, FORCE].curve.largest
        assert fit.dugoff.rms_torque > 0.2 * fit.fits[SLIP, TORQUE].curve.largest
