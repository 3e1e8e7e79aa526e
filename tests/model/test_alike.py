"""What records say looks alike: the same is said by all, and where no motion tells two apart, none does."""

from __future__ import annotations

import numpy as np
import pytest

from tests.model.effects.chair import run
from wheelchair_fmu.model.alike import EFFECTIVE_MASS, READING_OFFSET, TURNED_PATCHES, WHOLE_SCALE, look_alikes
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.wheelchair import base_parameters

PUSHES = {"push.F_rl": lambda t: 12 + 10 * np.sin(1.5 * t), "push.F_rr": lambda t: 10 + 10 * np.sin(1.5 * t + 1)}
AMONG = ("accelerometer_bias", "accelerometer_tilt", "push_force_gain", "wheel_inertia")  # one model for all
READ = ("sensor.wheel_speed_l", "sensor.wheel_speed_r", "sensor.yaw_rate", "sensor.a_x", "sensor.a_y")


def test_what_one_is_said_to_look_like_looks_like_it():
    catalogue = bundled()
    known = {p.name for p in base_parameters()}
    for id, effect in catalogue.items():
        for alike in effect.alike:
            others = look_alikes(effect, alike, catalogue)
            assert others, (id, alike)
            for other in others:
                assert other in known or id in look_alikes(catalogue[other], alike, catalogue)
    assert {"scrub_torque", "scrub_torque_viscous"} <= {
        o for alike in catalogue["turn_slip"].alike for o in look_alikes(catalogue["turn_slip"], alike, catalogue)
    }


def changes(pushes=PUSHES, **values: float) -> np.ndarray:
    """What small values do to all readings of a lively run on a level floor, per size."""
    step = 1e-3
    one, other = (run({n: s * step * v for n, v in values.items()} | START, pushes, T=3, among=AMONG) for s in (1, -1))
    return np.concatenate([(one[name] - other[name]) / (2 * step) for name in READ])


START = {"start.u": 1.2, "start.psi_dot": 0.3}


def cosine(a: np.ndarray, b: np.ndarray) -> float:
    return float(a @ b / np.linalg.norm(a) / np.linalg.norm(b))


SLALOM = {"push.F_rl": lambda t: 6 + 8 * np.sin(1.5 * t), "push.F_rr": lambda t: 6 - 8 * np.sin(1.5 * t)}


@pytest.mark.parametrize(("pushes", "share"), [(PUSHES, 0.99), (SLALOM, 0.999)])
def test_a_chair_that_rolls_does_not_tell_patches_that_are_turned_from_casters_that_drag_more(pushes, share):
    """A caster at δ = a ψ'/u drags f_f N_f aside, a moment that grows with ψ'/u as that of a turned patch does: of what 1 N m
    does nothing is left but a little where the chair is slow. Each coefficient alone also brakes the chair, and does not."""
    assert TURNED_PATCHES in bundled()["turn_slip"].alike
    defaults = {p.name: p.default for p in base_parameters()}
    usual = {**{name: defaults[name] for name in TURNED_PATCHES.with_parameters}, "effect.turn_slip.M": 0.5}

    def change(name: str) -> np.ndarray:
        ways = ({**START, **usual, name: usual[name] + side} for side in (1e-3, -1e-3))
        one, other = (run(values, pushes, T=6, among=["turn_slip"]) for values in ways)
        return np.concatenate([(one[read] - other[read]) / 2e-3 for read in READ])

    patches, drags = change("effect.turn_slip.M"), np.stack([change(n) for n in TURNED_PATCHES.with_parameters], axis=1)
    for columns, least, most in (([0, 1], share, 1.0), ([0], 0.0, 0.05), ([1], 0.0, 0.05)):
        left = patches - drags[:, columns] @ np.linalg.lstsq(drags[:, columns], patches, rcond=None)[0]
        assert least <= 1 - left @ left / (patches @ patches) <= most


@pytest.mark.parametrize(("angle", "offset"), [("pitch", "x"), ("roll", "y")])
def test_no_motion_tells_an_offset_from_a_tilt(angle, offset):
    assert bundled()["accelerometer_tilt"].alike == bundled()["accelerometer_bias"].alike == (READING_OFFSET,)
    tilt, bias = changes(**{f"effect.accelerometer_tilt.{angle}": 1.0}), changes(**{f"effect.accelerometer_bias.{offset}": 1.0})
    assert abs(cosine(tilt, bias)) > 1 - 1e-6


def test_no_motion_tells_the_scale_of_all_forces():
    """A chair of everything a tenth larger, with records a tenth too small of what acts on it, moves as the first."""
    assert WHOLE_SCALE in bundled()["push_force_gain"].alike
    scale = 1.1
    defaults = {p.name: p.default for p in base_parameters()}
    heavier = {name: scale * defaults[name] for name in WHOLE_SCALE.with_parameters}
    one, other = (
        run(START, PUSHES, T=3, among=AMONG),
        run({**START, **heavier, "effect.push_force_gain.mean": 1 / scale - 1}, PUSHES, T=3, among=AMONG),
    )
    for name in READ:
        np.testing.assert_allclose(one[name], other[name], atol=1e-7)


def test_straight_on_spinning_wheels_are_mass():
    assert EFFECTIVE_MASS in bundled()["wheel_inertia"].alike
    straight = {"push.F_rl": PUSHES["push.F_rl"], "push.F_rr": PUSHES["push.F_rl"]}
    spin = run(
        {"start.u": 1.0, "resistance.f_r": 0.0, "resistance.f_f": 0.0, "effect.wheel_inertia.m": 5.0},
        straight,
        T=3,
        among=AMONG,
    )
    mass = run({"start.u": 1.0, "resistance.f_r": 0.0, "resistance.f_f": 0.0, "chair.m": 85.0}, straight, T=3, among=AMONG)
    np.testing.assert_allclose(spin["chair.u"], mass["chair.u"], atol=1e-9)


RUNS = [  # strokes, a turn to each side, a slalom: push of both hands, and what the left pushes more
    ({"start.u": 0.6}, lambda t: 18 * np.maximum(np.sin(2 * np.pi * t), 0) ** 2, lambda t: 0 * t),
    ({"start.u": 1.0}, lambda t: 9.4 + 0 * t, lambda t: 7.0 * (t > 1)),
    ({"start.u": 1.0}, lambda t: 9.4 + 0 * t, lambda t: -7.0 * (t > 1)),
    ({"start.u": 0.9}, lambda t: 10.5 + 0 * t, lambda t: 10 * np.cos(1.6 * t)),
]
FORWARD = {  # parameters and their sizes of interest
    "effect.aerodynamic_drag.k": 0.2,
    "effect.camber_misalignment.difference": 0.005,
    "effect.camber_misalignment.sum": 0.005,
    "effect.floor_cross_slope.theta": 0.001,
    "effect.lateral_load_transfer.h": 0.3,
    "effect.longitudinal_load_transfer.h": 0.3,
    "effect.push_force_gain.difference": 0.02,
    "effect.push_force_gain.mean": 0.02,
    "effect.rolling_resistance_asymmetry.D": 0.4,
    "effect.rolling_resistance_speed.k": 0.3,
    "effect.scrub_torque_viscous.d": 0.2,
    "effect.toe_misalignment.difference": 0.005,
    "effect.toe_misalignment.sum": 0.005,
    "effect.wheel_inertia.m": 1.0,
    "effect.wheel_radius_error.difference": 0.01,
    "effect.wheel_radius_error.mean": 0.01,
}
NOISE = dict(zip(READ, (0.008, 0.008, 0.006, 0.05, 0.05), strict=True))


@pytest.fixture(scope="module")
def seen() -> dict[str, np.ndarray]:
    """What each does to all readings of these runs, in standard deviations of their noise, at its size of interest."""
    among = tuple(sorted({name.split(".")[1] for name in FORWARD}))

    def readings(values: dict[str, float]) -> np.ndarray:
        driven = [
            run(
                {**start, **values},
                {"push.F_rl": lambda t, f=both, d=more: f(t) + d(t), "push.F_rr": lambda t, f=both, d=more: f(t) - d(t)},
                T=8,
                n=401,
                among=among,
            )
            for start, both, more in RUNS
        ]
        return np.concatenate([result[name] / NOISE[name] for result in driven for name in READ])

    without, share = readings({}), 0.05
    return {name.removeprefix("effect."): (readings({name: share * d}) - without) / share for name, d in FORWARD.items()}


@pytest.mark.parametrize(
    ("one", "other", "at_least"),
    [
        ("aerodynamic_drag.k", "rolling_resistance_speed.k", 0.95),
        ("longitudinal_load_transfer.h", "wheel_inertia.m", 0.99),
        ("lateral_load_transfer.h", "scrub_torque_viscous.d", 0.93),
        ("camber_misalignment.sum", "rolling_resistance_asymmetry.D", 0.95),
        ("camber_misalignment.sum", "floor_cross_slope.theta", 0.95),
        ("floor_cross_slope.theta", "rolling_resistance_asymmetry.D", 0.95),
    ],
)
def test_look_alikes_look_alike_forward(seen, one, other, at_least):
    assert abs(cosine(seen[one], seen[other])) > at_least
    first, second = (set(bundled()[name.split(".")[0]].alike) for name in (one, other))
    assert first & second


@pytest.mark.parametrize("pair", ["push_force_gain", "toe_misalignment", "wheel_radius_error"])
def test_sums_and_differences_are_seen_apart(seen, pair):
    whole = "sum" if f"{pair}.sum" in seen else "mean"
    assert abs(cosine(seen[f"{pair}.{whole}"], seen[f"{pair}.difference"])) < 0.35


def test_forward_nothing_shows_the_difference_of_two_cambers(seen):
    assert np.linalg.norm(seen["camber_misalignment.difference"]) < 1e-3 * np.linalg.norm(seen["camber_misalignment.sum"])
