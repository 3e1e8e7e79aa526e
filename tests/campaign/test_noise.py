"""Noise: stated in the unit of the column, or estimated."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read

from .small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows


def test_missing_noise_is_estimated_and_said(campaign):
    folder = campaign(noise=NOISE.replace("yaw_rate = 0.006\n", ""))
    c = read(folder)
    assert c.noise_estimated == {"yaw_rate"}
    assert c.noise["yaw_rate"] == pytest.approx(0.006, rel=0.15)
    assert [str(w) for w in c.warnings] == [
        f"warning: campaign.toml line 6: noise not given, estimated from the samples: yaw_rate "
        f"{c.noise['yaw_rate']:.2g} rad/s; write what the sensors' data sheets say in [noise]"
    ]


def test_noise_is_in_the_unit_of_the_column(campaign):
    data = motion() * [1, 1, 1, 1, 1, 180 / np.pi, 1]
    files = dict.fromkeys(("a.csv", "b.csv"), csv_text([*SI[:5], "yaw_rate [deg/s]", SI[6]], rows(data)))
    assert read(campaign(noise=NOISE.replace("0.006", "0.3"), files=files)).noise["yaw_rate"] == np.radians(0.3)
    assert read(campaign(noise=NOISE.replace("0.006", "'0.3 deg/s'"))).noise["yaw_rate"] == np.radians(0.3)


def test_noise_in_two_units_asks_which(campaign):
    files = {"a.csv": csv_text([*SI[:5], "yaw_rate [deg/s]", SI[6]], rows(motion()))}
    errors = [str(f) for f in check(campaign(files=files)) if f.severity == "error"]
    assert errors == [
        "campaign.toml line 11: [noise] yaw_rate: 0.006 could be in several units, as the runs' columns differ; "
        "write the unit with it, as in yaw_rate = '0.006 rad/s'"
    ]


def test_noise_faults(campaign):
    noise = NOISE.replace("a_y = 0.05", "a_y = 0.0").replace("yaw_rate =", "yaw_rte =").replace("F_rr = 0.4", "F_rr = 40.0")
    lines = [str(f) for f in check(campaign(noise=noise))]
    assert lines[0] == "campaign.toml line 11: [noise] has no channel 'yaw_rte'; did you mean 'yaw_rate' or 'yaw'?"
    assert lines[1] == "campaign.toml line 12: [noise] a_y: 0.0 is not positive; give a standard deviation above 0"
    assert lines[3].startswith("warning: campaign.toml line 8: noise of F_rr is 40 N, but from sample to sample only 0.")
    assert len(lines) == 4


def test_pushes_that_nobody_gave_have_no_noise(campaign):
    runs = RUNS.replace("u0 = 1.0", "u0 = 1.0\nconstant = { F_rl = 0.0, F_rr = 0.0 }")
    keep = [0, 3, 4]
    files = dict.fromkeys(("a.csv", "b.csv"), csv_text([SI[i] for i in keep], rows(motion()[:, keep])))
    c = read(campaign(noise="", runs=runs, files=files))
    assert c.noise["F_rl"] == c.noise["F_rr"] == 0.0
    assert c.noise_estimated == {"wheel_speed_l", "wheel_speed_r"}


def test_a_constant_channel_needs_its_noise(campaign):
    runs = RUNS.replace("u0 = 1.0", "u0 = 1.0\nconstant = { u = 1.0 }")
    assert [str(f) for f in check(campaign(head=HEAD, runs=runs)) if f.severity == "error"] == [
        "campaign.toml line 6: the noise of u is not given and cannot be estimated from its samples; "
        "write [noise] u = ... , or remove the channel"
    ]
