"""The measurements that lie beside the project, where they do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import check, read, read_smartwheel

MEASUREMENTS = Path(__file__).resolve().parents[3] / "shared" / "measurements"


def folder(name: str) -> Path:
    path = MEASUREMENTS / name
    if not path.exists():
        pytest.skip(f"{name} is not there: the measurements are no part of the project")
    return path


OPEN = (
    "00-null",
    "01-relaxation",
    "02-crossfall",
    "03-camber",
    "04-scrub",
    "05-caster-friction",
    "06-left-drag",
    "07-cm-offset",
    "08-straight-only",
    "09-outside",
    "10-slow-null",
    "11-trunk",
)


@pytest.mark.parametrize("name", OPEN)
def test_simulated_campaigns_are_clean(name):
    path = folder(f"open-{name}")
    assert [str(fault) for fault in check(path)] == []
    c = read(path)
    assert c.fit and (c.holdout or name == "08-straight-only")
    assert set(c.runs[0].channels) <= set(c.noise) and not c.noise_estimated


def test_a_real_chair_in_iso_axes():
    path = folder("real/worklab")
    c = read(path)
    file = pd.read_csv(path / "imu_merged_100Hz.csv")
    cut = file[(file.t_s >= 7.6) & (file.t_s < 20.0)]
    run = c.runs[0]
    assert [r.name for r in c.runs] == ["imu_merged_100Hz", "imu_merged_100Hz-2"]
    np.testing.assert_allclose(run.time, cut.t_s)
    np.testing.assert_allclose(run.channels["yaw_rate"], -cut.yaw_rate_radps)
    np.testing.assert_allclose(run.channels["a_y"], -cut.ay_mps2)
    np.testing.assert_allclose(run.channels["wheel_speed_l"], 0.3 * cut.wheelL_radps)
    np.testing.assert_allclose(run.inputs["push.F_rl"], 0.0)
    assert 2.0 < run.u0 < 2.3
    assert all(fault.severity == "warning" for fault in check(path))


@pytest.mark.parametrize("name", ["worklab/Smartwheel_example.txt.gz", "kineticstoolkit/pushrimkinetics_propulsion.csv.gz"])
def test_real_smartwheels_push_forward(name):
    frame = read_smartwheel(folder(f"real/{name}"), "l", 0.3)
    assert 20 < frame["M_rl [N.m]"].max() < 40
    assert frame["M_rl [N.m]"].mean() > 1
