"""The stiffness that a measured turn needs, found again in turns of the simulated chair."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.handling.measured_turn import RANGES, HubMotion, balance, draws, dugoff, friction_needed, scatter, stiffness
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

TOLD = {"half_track": 0.275, "b": 0.20, "wheelbase": 0.45, "height": 0.0, "camber": 0.0, "camber_stiffness": 0.0}
LOAD = 80 * 9.81 * 0.25 / 0.45 / 2  # N on each rear wheel


def recorded(tyre="linear", **values) -> HubMotion:
    """The left hub of the simulated chair going into a right turn at 2.9 m/s."""
    held = {"speed.mode": "prescribed", "speed.u": 2.9, "resistance.f_f": 0.0}
    variant = Variant(Choice(tyre=tyre)).with_values({**held, **values})
    simulator = Simulator(variant)
    t = np.arange(0, 0.6, 1 / 120)
    force = np.interp(t, (0.1, 0.4), (0.0, 100.0))
    run = simulator.run(t, simulator.inputs(len(t), {"push.F_rl": force, "push.F_rr": -force}))
    u, v, r = (run[f"chair.{name}"] for name in ("u", "v", "psi_dot"))
    return HubMotion(t, u + 0.275 * r, v - 0.20 * r, r)


def known(**more) -> dict[str, np.ndarray]:
    return draws(1, np.random.default_rng(0), 0.0, **{**TOLD, **more})


@pytest.mark.parametrize("C_lambda", [2500.0, 5038.0])
def test_it_finds_the_simulated_tyres_stiffness(C_lambda):
    motion = recorded(**{"tyre.C_lambda": C_lambda})
    chosen = motion.time > 0.2
    assert stiffness(motion, known(), chosen) == pytest.approx(C_lambda / LOAD, rel=0.01)
    assert scatter(motion, known(), chosen) < 0.02


def test_it_allows_for_load_that_shifts_and_wheels_that_lean():
    values = {
        "effect.lateral_load_transfer.h": 0.5,
        "effect.load_sensitivity.exponent": 0.0,
        "effect.camber_misalignment.difference": -0.2,
    }
    motion = recorded(**values)
    upright = stiffness(motion, known(height=0.5), motion.time > 0.2)
    leaning = stiffness(motion, known(height=0.5, camber=0.1, camber_stiffness=464 / LOAD), motion.time > 0.2)
    assert leaning < upright  # camber carries a part where the outer wheel has more load


def test_the_stiffness_of_a_saturating_tyre_falls_and_its_friction_is_found():
    motion = recorded("dugoff", **{"tyre.mu": 0.8, "tyre.c_p": 0.0})
    slip = motion.slip()
    onset, late = (motion.time > 0.15) & (slip < 0.01), slip > 0.03
    ratio = stiffness(motion, known(), late) / stiffness(motion, known(), onset)
    assert ratio < 0.85
    assert scatter(motion, known(), onset | late) > 0.05
    assert friction_needed(motion, known(), late, 5038 / LOAD) == pytest.approx(0.8, rel=0.02)


def test_dugoffs_law_and_where_no_friction_suffices():
    lam = np.array([0.001, 0.1])
    assert dugoff(12.0, np.array(1.0), lam)[0] == pytest.approx(12.0 * np.tan(0.001))
    gamma = 1.0 / (2 * 12.0 * np.tan(0.1))
    assert dugoff(12.0, np.array(1.0), lam)[1] == pytest.approx(12 * np.tan(0.1) * gamma * (2 - gamma))
    motion = recorded()
    assert friction_needed(motion, known(), motion.time > 0.3, 0.5 * 5038 / LOAD) == np.inf


def test_unknowns_are_drawn_in_their_ranges_and_mirror_nothing():
    found = draws(500, np.random.default_rng(0), 0.01, camber=0.2)
    for name, (low, high) in RANGES.items():
        if name != "camber":
            assert low <= found[name].min() and found[name].max() <= high and np.ptp(found[name]) > 0.9 * (high - low)
    assert np.all(found["camber"] == 0.2) and found["slip_zero"].std() == pytest.approx(0.01, rel=0.1)
    carried, by = balance(recorded(), found)
    assert carried.shape == by.shape == (500, 72)


def test_the_docs_say_what_the_recording_gives(capsys, monkeypatch, tmp_path):
    root = Path(__file__).parents[2]
    place = root.parent / "shared" / "measurements" / "real" / "kineticstoolkit" / "basket_sprint_frame_pose_120Hz.csv"
    if not place.is_file():
        pytest.skip(f"needs the recording {place.name}")
    monkeypatch.syspath_prepend(root / "examples")
    import real_turn

    told = (root / "docs" / "real-turn.md").read_text(encoding="utf-8")
    for line in real_turn.report(real_turn.read(place)):
        assert line in told, line
    real_turn.draw(real_turn.read(place), tmp_path / "turn.png")
    assert (tmp_path / "turn.png").stat().st_size > 10_000
