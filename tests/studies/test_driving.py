"""Driving an FMU: as exact as the engine, and what it refuses comes in its own words."""

from __future__ import annotations

from pathlib import Path

import fmpy
import numpy as np
import pytest

from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.errors import Failure, FormerName, SimulationError, UsageError
from wheelchair_fmu.fmu.build import build, with_chosen_effects
from wheelchair_fmu.handling.manoeuvres import MANOEUVRES, manoeuvre
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies import Fmu, fmu_of


def engine(time, inputs, values):
    """The same run by the engine, on the steps of the FMU."""
    simulator = Simulator(with_chosen_effects(Variant()).with_values(values))
    return simulator.run(time, simulator.inputs(len(time), inputs), tolerance=1e-7, grid=1e-3)


@pytest.mark.parametrize("name", MANOEUVRES)
def test_it_equals_the_engine_on_every_manoeuvre(fmu, name):
    m = manoeuvre(name)
    result, expected = fmu.run(m.time, m.inputs, m.values), engine(m.time, m.inputs, m.values)
    for output in expected.names:
        assert result[output] == pytest.approx(expected[output], rel=1e-9, abs=1e-9), output


def test_it_equals_the_engine_on_an_uneven_clock_with_noisy_pushes(fmu):
    rng = np.random.default_rng(5)
    time = 7.6 + np.cumsum(rng.uniform(0.003, 0.02, 300))
    inputs = {"push.F_rl": rng.normal(8, 5, 300), "push.F_rr": rng.normal(8, 5, 300)}
    result, expected = fmu.run(time, inputs, {"chair.m": 92.0}), engine(time, inputs, {"chair.m": 92.0})
    assert result["chair.psi"] == pytest.approx(expected["chair.psi"], abs=1e-6)
    assert result["sensor.a_x"] == pytest.approx(expected["sensor.a_x"], abs=1e-5)


def test_it_equals_fmpys_own_loop_where_that_is_exact(fmu):
    """With constant inputs the slopes that fmpy sets late are zero anyway."""
    time = np.arange(201) * 0.01
    result = fmu.run(time, {"push.F_rl": np.full(201, 20.0)}, {"start.u": 0.3})
    theirs = fmpy.simulate_fmu(
        str(fmu.path),
        start_values={"push.F_rl": 20.0, "start.u": 0.3},
        stop_time=2.0,
        output_interval=0.01,
        output=["chair.x", "chair.psi"],
    )
    for name in ("chair.x", "chair.psi"):
        assert result[name] == pytest.approx(theirs[name], abs=1e-9)


def test_the_same_run_again_gives_the_same_numbers(fmu):
    m = manoeuvre("slalom", time=2.0)
    first = fmu.run(m.time, m.inputs, {**m.values, "tyre.C_lambda": 2500.0})
    fmu.run(m.time, m.inputs, {"start.u": 0.2, "tyre.law": "dugoff"})
    again = fmu.run(m.time, m.inputs, {**m.values, "tyre.C_lambda": 2500.0})
    assert all(np.array_equal(first[name], again[name]) for name in fmu.outputs)


def test_a_bad_value_is_refused_and_the_next_run_is_good(fmu):
    time = np.arange(11) * 0.01
    for values, sentence in (
        ({"chair.m": -1.0}, "chair.m = -1.0 is outside its bounds 1 to 1000 kg"),
        ({"chair.n": 1.0}, "no parameter 'chair.n'; did you mean 'chair.m'"),
        ({"floor.slope_x": 0.1}, "no parameter 'floor.slope_x'"),
        ({"speed.mode": "fast"}, "speed.mode = fast: choose one of free, prescribed"),
        ({"tyre.law": 7.0}, "tyre.law = 7: choose one of linear, dugoff, magic_formula"),
        ({"g": float("nan")}, "g = nan is outside its bounds"),
    ):
        with pytest.raises(UsageError) as refused:
            fmu.run(time, {}, values)
        assert sentence in str(refused.value)
    with pytest.raises(UsageError, match="no input of Wheelchair 'push'"):
        fmu.run(time, {"push": time})
    with pytest.raises(UsageError, match=r"no output 'chair\.w'"):
        fmu.run(time, {})["chair.w"]
    assert fmu.run(time, {})["chair.u"][0] == 1.0


def test_what_the_fmu_refuses_comes_in_its_own_words(fmu):
    time = np.arange(11) * 0.01
    with pytest.raises(SimulationError, match=r"Wheelchair: push\.F_rl = nan is not a finite number"):
        fmu.run(time, {"push.F_rl": np.full(11, np.nan)})
    beyond = fmu.run(time, {"push.F_rr": np.full(11, 5000.0)})
    assert any("push.F_rr = 5000 N is above its maximum of 2000 N" in warning for warning in beyond.warnings)
    with pytest.raises(SimulationError, match="time does not rise"):
        fmu.run(time[::-1], {})
    assert fmu.run(time, {})["chair.x"][-1] > 0.09


def test_leaving_the_models_range_is_a_warning(fmu):
    time = np.arange(201) * 0.01
    result = fmu.run(time, {"push.F_rl": np.full(201, 400.0), "push.F_rr": np.full(201, -400.0)})
    assert any("slip" in warning for warning in result.warnings)
    assert not fmu.run(time, {}).warnings


def test_the_python_flavour_runs_too_with_its_inputs_held(tmp_path, fmu):
    m = manoeuvre("steady-turn", time=1.0)
    with Fmu(build(target=tmp_path / "p.fmu", flavour="python")) as driven:
        result = driven.run(m.time, m.inputs, m.values)
    assert result["chair.psi"] == pytest.approx(fmu.run(m.time, m.inputs, m.values)["chair.psi"], abs=1e-9)


def test_a_files_flaws_are_said(tmp_path):
    with pytest.raises(Failure, match="no such file"):
        Fmu(tmp_path / "none.fmu")
    (tmp_path / "text.fmu").write_text("not a zip")
    with pytest.raises(Failure, match="not an FMU"):
        Fmu(tmp_path / "text.fmu")


def test_a_variants_fmu_is_built_once_and_serves_all_values(monkeypatch):
    path = fmu_of(Variant())
    monkeypatch.setattr("wheelchair_fmu.studies.archives.build", None)  # calling it would fail
    assert fmu_of(Variant().with_values({"chair.m": 90.0})) == path
    with pytest.raises(TypeError):
        fmu_of(Variant(), "gyro_scale,floor_slope,caster_trail")


def test_closing_leaves_no_files_behind():
    with Fmu(fmu_of(Variant())) as driven:
        folder = Path(driven._folder)
        assert (folder / "modelDescription.xml").is_file()
    assert not folder.exists()


def test_former_names_are_read_where_the_fmu_has_todays(fmu):
    with pytest.warns(FormerName, match="former name, read as"):
        given = fmu.checked({"effect.toe_misalignment.tau_r": "0.01", "chair.m": 81})
    assert given == pytest.approx(
        {"chair.m": 81, "effect.toe_misalignment.sum": 0.01, "effect.toe_misalignment.difference": 0.01}
    )
