"""Recorded runs through the FMU."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.campaign import Run, read
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.errors import SimulationError, UsageError
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.measured import run_campaign_run

SAMPLE = Path(__file__).parents[2] / "examples" / "sample-campaign"
TIME = np.arange(101) * 0.01


def run_of(**changes) -> Run:
    fields = dict(
        name="r",
        file=Path("r.csv"),
        manoeuvre="",
        role="fit",
        u0=0.5,
        set={},
        time=TIME,
        inputs={"push.F_rl": 0 * TIME + 6, "push.F_rr": 0 * TIME + 6},
        channels={"u": 0 * TIME, "yaw_rate": 0 * TIME},
    )
    return Run(**{**fields, **changes})


def test_the_sample_campaign_runs_and_needs_its_left_drag(fmu):
    campaign = read(SAMPLE)
    run = next(r for r in campaign.runs if r.name == "steady-left")
    rms = {}
    for drag in (0.0, 2.0):
        seen = run_campaign_run(fmu, run, {**campaign.known, "effect.rolling_resistance_asymmetry.D": drag})
        assert seen.keys() == run.channels.keys()
        rms[drag] = float(np.sqrt(np.mean((seen["yaw_rate"] - run.channels["yaw_rate"]) ** 2)))
    assert rms[2.0] < 0.8 * rms[0.0]


def test_it_predicts_what_the_engine_does(fmu):
    campaign = read(SAMPLE)
    run = campaign.runs[0]
    simulator = Simulator(Variant().with_values({**campaign.known, "start.u": run.u0}))
    expected = simulator.run(run.time, simulator.inputs(len(run.time), run.inputs), tolerance=1e-7)
    seen = run_campaign_run(fmu, run, campaign.known)
    assert seen["wheel_speed_l"] == pytest.approx(expected["sensor.wheel_speed_l"], abs=1e-5)


def test_the_runs_own_values_go_first_and_starts_come_from_the_run(fmu):
    seen = run_campaign_run(fmu, run_of(set={"chair.m": 160.0}), {"chair.m": 80.0})
    light = run_campaign_run(fmu, run_of(), {"chair.m": 80.0})
    assert seen["u"][0] == light["u"][0] == 0.5 and seen["u"][-1] < light["u"][-1]
    assert run_campaign_run(fmu, run_of(), {"start.u": 0.9})["u"][0] == 0.9
    tracked = run_of(channels={"x": np.r_[np.nan, np.full(100, 3.0)], "yaw": np.full(101, 0.2)})
    assert run_campaign_run(fmu, tracked, {})["x"][0] == 3.0 and run_campaign_run(fmu, tracked, {})["yaw"][0] == 0.2


def test_casters_that_have_no_angle_of_their_own_start_nowhere(fmu):
    """A run that was filmed may say where its casters stood; the ideal casters of this FMU trail at once."""
    turned = run_campaign_run(fmu, run_of(set={"start.caster_l": 0.4}), {})
    np.testing.assert_array_equal(turned["u"], run_campaign_run(fmu, run_of(), {})["u"])
    with pytest.raises(UsageError, match=r"no parameter 'start\.castor_l'"):
        run_campaign_run(fmu, run_of(set={"start.castor_l": 0.4}), {})


def test_a_refusal_names_the_run(fmu):
    with pytest.raises(SimulationError, match=r"^run r: Wheelchair: push\.F_rl = inf"):
        run_campaign_run(fmu, run_of(inputs={"push.F_rl": np.full(101, np.inf)}), {})
