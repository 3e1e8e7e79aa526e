"""The hidden effects and the campaigns written with them."""

from __future__ import annotations

import csv
import json
import tomllib
from functools import cache

import numpy as np
import pytest

from benchmarks.independent.campaigns import (
    CHANNELS,
    NOISE,
    ROOM_CHANNELS,
    Recorded,
    main,
    make,
    noisy,
    nominal,
    record,
    signal,
    truth,
)
from benchmarks.independent.hidden import CATALOGUE, EFFECTS, OUTSIDE, usual
from benchmarks.independent.manoeuvres import SETS, Run, pick

SHORT = ["steady-right", "coast-down"]
IDS = {
    "tyre_saturation",
    "load_sensitivity",
    "inflation_pressure",
    "relaxation_length",
    "pneumatic_trail_decay",
    "camber_misalignment",
    "toe_misalignment",
    "scrub_torque",
    "scrub_torque_viscous",
    "turn_slip",
    "pivot_torque",
    "longitudinal_slip",
    "lateral_load_transfer",
    "longitudinal_load_transfer",
    "cm_lateral_offset",
    "trunk_motion",
    "stroke_motion",
    "caster_inertia",
    "caster_friction",
    "caster_trail",
    "rolling_resistance_speed",
    "rolling_resistance_asymmetry",
    "aerodynamic_drag",
    "floor_slope",
    "floor_cross_slope",
    "wheel_inertia",
    "push_force_gain",
    "push_force_delay",
    "gyro_bias",
    "gyro_scale",
    "accelerometer_bias",
    "accelerometer_offset",
    "marker_offset",
    "accelerometer_tilt",
    "wheel_radius_error",
}


@cache
def without(run: Run) -> Recorded:
    return record(run, truth({}))


def test_the_catalogue_is_whole():
    assert set(CATALOGUE) == IDS
    assert len(OUTSIDE) >= 5
    for effect in EFFECTS.values():
        assert effect.sees in SETS
        assert all(p.delta > 0 and p.unit and p.sign for p in effect.parameters.values())


@pytest.mark.parametrize("effect", EFFECTS)
def test_zero_is_off(effect):
    assert truth({effect: usual(effect, 0.0)}, seed=3) == truth({}, seed=3)


@pytest.mark.parametrize("effect", EFFECTS)
def test_three_times_the_smallest_interesting_size_is_seen(effect):
    """In the set that should see it some channel (a force sensor's too) changes by more than 0.2 standard deviations."""
    true = truth({effect: usual(effect, 3.0)})
    runs = pick(EFFECTS[effect].sees)
    for run in sorted(runs, key=lambda r: r.manoeuvre == "coast-down" or r.role == "holdout"):
        one, other = record(run, true).columns, without(run).columns
        if any(
            np.max(np.abs(one[c] - other[c])) > 0.2 * NOISE[c] for c in (*CHANNELS, *EFFECTS[effect].channels, "F_rl", "F_rr")
        ):
            return
    pytest.fail(f"{effect} is invisible")


@pytest.mark.parametrize(
    ("effect", "channel", "run", "sign"),
    [
        ({"camber_misalignment": {"sum": 0.04}}, "yaw_rate", "straight-strokes", +1),
        ({"toe_misalignment": {"sum": 0.02}}, "v", "straight-strokes", +1),
        ({"rolling_resistance_asymmetry": {"D": 1.0}}, "yaw_rate", "straight-strokes", -1),
        ({"floor_cross_slope": {"theta": 0.003}}, "y", "straight-strokes", +1),
        ({"floor_slope": {"x": 0.003}}, "wheel_speed_l", "coast-down", +1),
        ({"aerodynamic_drag": {"k": 0.3}}, "wheel_speed_l", "coast-down", -1),
        ({"scrub_torque": {"M": 0.5}}, "yaw_rate", "steady-right", -1),
        ({"scrub_torque_viscous": {"d": 0.5}}, "yaw_rate", "steady-right", -1),
        ({"turn_slip": {"M": 2.0}}, "yaw_rate", "steady-right", -1),
        ({"turn_slip": {"M_f": 0.5}}, "yaw_rate", "steady-right", -1),
        ({"pivot_torque": {"M": 2.0}}, "yaw_rate", "left-hand", -1),
        ({"slipping_wheels": {"inv_mu": 3.0}}, "wheel_speed_l", "strong-strokes", +1),
        ({"cm_lateral_offset": {"y": 0.01}}, "yaw_rate", "straight-strokes", +1),
        ({"push_force_gain": {"mean": 0.025, "difference": -0.05}}, "F_rl", "coast-down", +1),
        ({"wheel_radius_error": {"mean": 0.01, "difference": 0.02}}, "wheel_speed_r", "coast-down", +1),
        ({"gyro_bias": {"b": 0.01}}, "yaw_rate", "coast-down", +1),
        ({"accelerometer_tilt": {"pitch": 0.01}}, "a_x", "coast-down", +1),
        ({"accelerometer_tilt": {"roll": 0.01}}, "a_y", "coast-down", -1),
        ({"longitudinal_slip": {"compliance": 3e-4}}, "wheel_speed_l", "steady-right", +1),
    ],
)
def test_signs(effect, channel, run, sign):
    run = pick(run)[0]
    change = record(run, truth(effect)).columns[channel] - without(run).columns[channel]
    assert sign * np.mean(change) > 0.01 * NOISE[channel]


def test_an_early_record_leads():
    run = pick("straight-strokes")[0]
    late, early = without(run).columns["F_rl"], record(run, truth({"push_force_delay": {"tau": 0.02}})).columns["F_rl"]
    np.testing.assert_allclose(early[:-2], late[2:], atol=1e-9)


def test_unknown_names_are_refused():
    with pytest.raises(KeyError, match="no effect"):
        truth({"magic": {}})
    with pytest.raises(KeyError, match="no parameter"):
        truth({"scrub_torque": {"d": 1}})
    with pytest.raises(KeyError, match="no chair parameter"):
        nominal({"wings": 2})
    with pytest.raises(KeyError, match="no set or run"):
        pick(["flight"])


def folder_bytes(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_the_same_seed_gives_the_same_bytes(tmp_path):
    hidden = {"scrub_torque": {"M": 0.4}}
    one, two, three = (make(tmp_path / str(i) / "c", hidden, manoeuvres=SHORT, seed=s) for i, s in enumerate((5, 5, 6)))
    assert folder_bytes(one) == folder_bytes(two)
    assert folder_bytes(one) != folder_bytes(three)
    assert truth({}, seed=5) != truth({}, seed=6)


@pytest.mark.parametrize("channels", [CHANNELS, ROOM_CHANNELS, ("yaw_rate", "u")])
def test_files(tmp_path, channels):
    manoeuvres = ["coast-down", "steady-right-heavy", "slalom-quick-pressure"]
    hidden = {"inflation_pressure": {"dp": -0.5}}
    folder = make(tmp_path / "some", hidden, manoeuvres=manoeuvres, channels=channels, noise_scale=2.0, chair={"m": 85.0})
    campaign = tomllib.loads((folder / "campaign.toml").read_text(encoding="utf-8"))
    assert campaign["campaign"] == {"name": "some", "axes": "SAE-J670"}
    assert campaign["chair"]["m"] == 85.0
    assert campaign["tyre"]["C_lambda"] == 5038.0 != truth(hidden).chair.C_lambda
    assert list(campaign["noise"]) == ["F_rl", "F_rr", *channels]
    assert campaign["noise"]["yaw_rate"] == 0.012
    assert [run.get("set") for run in campaign["run"]] == [None, {"chair.m": 115.0}, {"tyre.pressure": 2.0}]
    for told, run in zip(campaign["run"], pick(manoeuvres), strict=True):
        assert {"file", "manoeuvre", "role", "u0"} <= set(told)
        with (folder / told["file"]).open(encoding="utf-8") as lines:
            rows = list(csv.reader(lines))
        assert [h.split()[0] for h in rows[0]] == ["time", "F_rl", "F_rr", *channels]
        assert all(h.endswith("]") and " [" in h for h in rows[0])
        table = np.array(rows[1:], dtype=float)
        assert len(table) == round(run.duration * 100) + 1
        assert np.all(np.isfinite(table))
        np.testing.assert_allclose(table[:, 0], np.arange(len(table)) * 0.01, atol=1e-9)
    assert not any("inflation" in p.read_text(encoding="utf-8") for p in folder.rglob("*") if p.is_file())


@pytest.mark.parametrize(("kind", "neighbour"), [("white", 0.0), ("ar1", 0.9)])
def test_noise(kind, neighbour):
    run = pick("coast-down")[0]
    long = Recorded(run, {"time": np.zeros(40000), "yaw_rate": np.zeros(40000)})
    noise = noisy(long, ["yaw_rate"], kind, 1.0, 0)["yaw_rate"]
    assert np.std(noise) == pytest.approx(NOISE["yaw_rate"], rel=0.05)
    assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(neighbour, abs=0.02)


def test_signal_grows_with_the_effect():
    small, large = (signal({"aerodynamic_drag": {"k": k}}, manoeuvres=SHORT)["wheel_speed_l"] for k in (0.1, 0.3))
    assert 2 < large / small < 3.3


def test_command_line(tmp_path, capsys):
    out, told = tmp_path / "c", tmp_path / "answer.json"
    main([str(out), "--effect", "gyro_bias", "--times", "3", "--manoeuvres", "coast-down", "--room", "--answer", str(told)])
    assert capsys.readouterr().out.strip() == str(out)
    answer = json.loads(told.read_text(encoding="utf-8"))
    assert answer["hidden"] == {"gyro_bias": {"b": pytest.approx(0.009)}}
    assert answer["signal_to_noise"]["yaw_rate"] == pytest.approx(1.5)
    with pytest.raises(SystemExit):
        main([str(out), "--answer", str(out / "answer.json")])
