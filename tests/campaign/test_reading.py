"""What comes out of a sound campaign."""

from __future__ import annotations

import gzip

import numpy as np
import pytest

from wheelchair_fmu.campaign import CHANNELS, INPUTS, check, read, to_sae

from .small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows

LBF = 4.4482216152605


def one(headers, cells, **more):
    return {"a.csv": csv_text(headers, cells, **more)}


def both(headers, cells):
    return dict.fromkeys(("a.csv", "b.csv"), csv_text(headers, cells))


def test_a_sound_campaign_has_no_faults(campaign):
    folder = campaign()
    assert check(folder) == []
    c = read(folder)
    assert (c.name, c.axes, c.known, c.noise_estimated) == ("small", "SAE-J670", {"chair.m": 80.0}, frozenset())
    assert [run.name for run in c.fit] == ["a"] and [run.name for run in c.holdout] == ["b"]
    run = c.runs[0]
    data = motion()
    assert (run.manoeuvre, run.role, run.u0, run.set) == ("slalom", "fit", 1.0, {})
    assert list(run.inputs) == ["push.F_rl", "push.F_rr"]
    assert list(run.channels) == ["wheel_speed_l", "wheel_speed_r", "yaw_rate", "a_y"]
    np.testing.assert_allclose(run.time, data[:, 0])
    np.testing.assert_allclose(run.inputs["push.F_rr"], data[:, 2])
    np.testing.assert_allclose(run.channels["yaw_rate"], data[:, 5])


def test_the_toml_itself_may_be_named(campaign):
    assert read(campaign() / "campaign.toml").fingerprint == read(campaign()).fingerprint


def test_the_fingerprint_follows_every_file(campaign):
    first = read(campaign()).fingerprint
    assert read(campaign(files={"b.csv": csv_text(SI, rows(motion(seed=2)))})).fingerprint != first
    assert read(campaign(head=HEAD + "I_z = 3.0\n")).fingerprint != first


def test_every_channel_has_a_prediction_and_a_meaning():
    assert [c.name for c in CHANNELS] == ["wheel_speed_l", "wheel_speed_r", "yaw_rate", "a_x", "a_y", "x", "y", "yaw", "u", "v"]
    pushed = ["push.F_rl", "push.M_rl", "brake.rl", "push.F_rr", "push.M_rr", "brake.rr"]
    body = ["rider.s", "rider.momentum", "rider.force", "stroke.phase", "stroke.rate"]
    floor = ["floor.rolling_factor", "floor.slope_x", "floor.slope_y"]
    assert sorted(c.fmu for c in INPUTS) == sorted([*pushed, *body, *floor])
    assert all(c.meaning and c.fmu and c.low < c.high for c in CHANNELS + INPUTS)


UNITS = [
    ("time [ms]", 0, 1e3),
    ("F_rl [lbf]", 1, 1 / LBF),
    ("F_rr [kN]", 2, 1e-3),
    ("wheel_speed_l [km/h]", 3, 3.6),
    ("wheel_speed_r [mph]", 4, 1 / 0.44704),
    ("yaw_rate [deg/s]", 5, 180 / np.pi),
    ("a_y [g]", 6, 1 / 9.80665),
]


def test_any_unit_of_the_right_dimension(campaign):
    data = motion()
    other = data * [f for _, _, f in UNITS]
    run = read(campaign(files=one([h for h, _, _ in UNITS], rows(other)), noise="")).runs[0]
    np.testing.assert_allclose(run.time, data[:, 0], rtol=1e-9)
    np.testing.assert_allclose(run.inputs["push.F_rl"], data[:, 1], rtol=1e-9)
    np.testing.assert_allclose(run.inputs["push.F_rr"], data[:, 2], rtol=1e-9)
    for name, i in (("wheel_speed_l", 3), ("wheel_speed_r", 4), ("yaw_rate", 5), ("a_y", 6)):
        np.testing.assert_allclose(run.channels[name], data[:, i], rtol=1e-9, err_msg=name)


@pytest.mark.parametrize("unit", ["m/s^2", "m/s²", "m.s-2", "m/s**2"])
def test_ways_to_write_an_acceleration(campaign, unit):
    data = motion()
    run = read(campaign(files=one([*SI[:-1], f"a_y [{unit}]"], rows(data)))).runs[0]
    np.testing.assert_allclose(run.channels["a_y"], data[:, 6])


def test_push_torque_by_a_radius_in_columns_and_by_the_wheels(campaign):
    data = motion()
    headers = [SI[0], "left [N.m]", "F_rr [N.m]", *SI[3:]]
    head = HEAD + '[wheel]\nR = 0.3\n[columns]\nF_rl = { column = "left", radius = 0.25 }\n'
    run = read(campaign(head=head, noise="", files=dict.fromkeys(("a.csv", "b.csv"), csv_text(headers, rows(data))))).runs[0]
    np.testing.assert_allclose(run.inputs["push.F_rl"], data[:, 1] / 0.25)
    np.testing.assert_allclose(run.inputs["push.F_rr"], data[:, 2] / 0.3)


def test_wheel_speed_in_rpm(campaign):
    data = motion()
    headers = [*SI[:3], "wheel_speed_l [rpm]", *SI[4:]]
    run = read(campaign(head=HEAD + "[wheel]\nR = 0.3\n", noise="", files=one(headers, rows(data)))).runs[0]
    np.testing.assert_allclose(run.channels["wheel_speed_l"], data[:, 3] * 2 * np.pi / 60 * 0.3)


def test_axle_torque_and_brake_are_inputs_of_their_own(campaign):
    headers = [SI[0], "M_rl [N.m]", "M_rr [N.m]", *SI[3:6], "brake_rl [%]"]
    data = motion()
    data[:, 6] = 50.0
    run = read(campaign(files=one(headers, rows(data)))).runs[0]
    assert list(run.inputs) == ["push.M_rl", "push.M_rr", "brake.rl"]
    np.testing.assert_allclose(run.inputs["brake.rl"], 0.5)


def test_whole_header_wins_over_the_name_without_bracket(campaign):
    data = motion()
    data[:, 6] *= 180 / np.pi
    headers = [*SI[:5], "yaw_rate [rad/s]", "yaw_rate [deg/s]"]
    head = HEAD + '[columns]\nyaw_rate = "yaw_rate [deg/s]"\n'
    run = read(campaign(head=head, files=both(headers, rows(data)), noise="")).runs[0]
    np.testing.assert_allclose(run.channels["yaw_rate"], data[:, 6] * np.pi / 180)


def test_renamed_column_whose_bracket_gives_the_unit(campaign):
    data = motion()
    head = HEAD + '[columns]\nyaw_rate = "gyro_z [deg/s]"\n'
    run = read(campaign(head=head, noise="", files=both([*SI[:5], "gyro_z", SI[6]], rows(data)))).runs[0]
    np.testing.assert_allclose(run.channels["yaw_rate"], data[:, 5] * np.pi / 180)


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_separators(campaign, separator):
    data = motion()
    run = read(campaign(files=one(SI, rows(data), separator=separator))).runs[0]
    np.testing.assert_allclose(run.channels["a_y"], data[:, 6])


def test_decimal_commas(campaign):
    data = motion()
    text = csv_text(SI, rows(data), ";").replace(".", ",")
    run = read(campaign(files={"a.csv": text})).runs[0]
    np.testing.assert_allclose(run.channels["a_y"], data[:, 6])


@pytest.mark.parametrize("dress", ["bom", "crlf", "blank lines", "quotes", "spaces", "no newline at the end"])
def test_harmless_dress(campaign, dress):
    data = motion()
    text = csv_text(SI, rows(data))
    raw = {
        "bom": text.encode("utf-8-sig"),
        "crlf": text.replace("\n", "\r\n").encode(),
        "blank lines": ("\n" + text.replace("\n", "\n\n", 5) + "\n\n").encode(),
        "quotes": csv_text([f'"{h}"' for h in SI], [[f'"{c}"' for c in r] for r in rows(data)]).encode(),
        "spaces": text.replace(",", " , ").encode(),
        "no newline at the end": text.rstrip("\n").encode(),
    }[dress]
    folder = campaign(files={"a.csv": raw})
    assert check(folder) == []
    np.testing.assert_allclose(read(folder).runs[0].channels["a_y"], data[:, 6])


def test_gzip(campaign):
    runs = RUNS.replace("a.csv", "a.csv.gz")
    folder = campaign(runs=runs, files={"a.csv.gz": gzip.compress(csv_text(SI, rows(motion())).encode())})
    assert [run.name for run in read(folder).runs] == ["a", "b"]


def test_gaps_stay_in_channels_and_are_bridged_in_inputs_when_short(campaign):
    data = motion()
    data[15:35, 1] = data[15:35, 0] * 10
    cells = rows(data)
    for i in range(20, 28):
        cells[i][1] = ""
    cells[50][6], cells[51][6], cells[52][6] = "", "NaN", "nan"
    folder = campaign(files=one(SI, cells))
    assert check(folder) == []
    run = read(folder).runs[0]
    np.testing.assert_allclose(run.inputs["push.F_rl"][15:35], run.time[15:35] * 10, atol=1e-9)
    assert np.flatnonzero(np.isnan(run.channels["a_y"])).tolist() == [50, 51, 52]


def test_from_and_to_keep_the_files_time_and_share_no_sample(campaign):
    runs = RUNS.replace("u0 = 1.0\n", "u0 = 1.0\nto = 1.0\n", 1).replace("b.csv", "a.csv")
    runs += "from = 1.0\n"
    c = read(campaign(runs=runs))
    assert [run.name for run in c.runs] == ["a", "a-2"]
    assert c.warnings == ()
    assert c.runs[0].time[[0, -1]].tolist() == [0.0, 0.99]
    assert c.runs[1].time[[0, -1]].tolist() == [1.0, 1.99]
    assert len(c.runs[1].channels["a_y"]) == len(c.runs[1].inputs["push.F_rl"]) == 100


def test_constants_stand_for_what_was_not_logged(campaign):
    runs = RUNS.replace("u0 = 1.0\n", 'u0 = 1.0\nconstant = { F_rl = 0.0, F_rr = "2 lbf", yaw = 0.5 }\n', 1)
    data = motion()[:, [0, 3, 4]]
    c = read(campaign(runs=runs, noise=NOISE + "yaw = 0.01\n", files=one([SI[0], *SI[3:5]], rows(data))))
    assert set(c.runs[0].inputs["push.F_rl"]) == {0.0}
    np.testing.assert_allclose(c.runs[0].inputs["push.F_rr"], 2 * LBF)
    assert set(c.runs[0].channels["yaw"]) == {0.5}


def test_axes_turn_and_turning_twice_is_the_identity(campaign):
    values = {c.name: np.arange(3.0) + i for i, c in enumerate(CHANNELS + INPUTS)}
    turned = to_sae(values, "ISO-8855")
    flipped = {name for name in values if (turned[name] == -values[name]).all()}
    assert flipped == {"a_y", "y", "v", "yaw", "yaw_rate", "floor.slope_y"}
    for name, series in to_sae(turned, "ISO-8855").items():
        np.testing.assert_allclose(series, values[name])
    assert all((to_sae(values, "SAE-J670")[name] == values[name]).all() for name in values)


def test_iso_campaign(campaign):
    data = motion()
    run = read(campaign(head=HEAD.replace("SAE-J670", "ISO-8855"))).runs[0]
    np.testing.assert_allclose(run.channels["yaw_rate"], -data[:, 5])
    np.testing.assert_allclose(run.channels["wheel_speed_l"], data[:, 3])


def test_parameters_priors_sets_and_nuisances(campaign):
    head = HEAD + "[tyre]\nforce.C = 1.3\n[tyre.torque]\nC = 1.1\n[prior]\n'tyre.C_lambda' = 500\nchair.I_z = 0.3\n"
    head += "[nuisance]\nyaw_rate = 0.002\na_y = true\nwheel_speed_l = false\n"
    runs = RUNS + 'set = { "chair.m" = 90, tyre.force.C = 1.5 }\n'
    c = read(campaign(head=head, runs=runs))
    assert c.known == {"chair.m": 80.0, "tyre.force.C": 1.3, "tyre.torque.C": 1.1}
    assert c.priors == {"tyre.C_lambda": 500.0, "chair.I_z": 0.3}
    assert c.runs[1].set == {"chair.m": 90.0, "tyre.force.C": 1.5}
    assert (c.nuisance, c.nuisance_sd) == (("yaw_rate", "a_y"), {"yaw_rate": 0.002})
