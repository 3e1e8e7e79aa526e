"""A sensor that is slower than the grid: readings in some rows only, repeated in the others, or joined by straight lines."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import Campaign, read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise import noise_model_of
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.model.variant import Variant

SAMPLE = Path(__file__).parents[2] / "examples" / "sample-campaign"
HEADER, NOISE = "yaw_rate [rad/s]", 0.006
FITTED = {
    "tyre.C_lambda": 4821.0,
    "resistance.f_r": 0.0179,
    "resistance.f_f": 0.0182,
    "chair.I_z": 3.091,
    "effect.rolling_resistance_asymmetry.D": 1.605,
}
HOW = ["every second", "repeated", "joined"]


def slower(folder: Path, how: str, stated: bool = True) -> Path:
    """The sample, whose gyro reads at 50 Hz, or at 30 Hz with its readings brought onto the grid."""
    shutil.copytree(SAMPLE, folder)
    for file in (folder / "runs").glob("*.csv"):
        rows = pd.read_csv(file)
        every, n = rows[HEADER].to_numpy(), np.arange(len(rows))
        new = np.ceil(np.arange(0, len(rows), 10 / 3)).astype(int)
        rows[HEADER] = {
            "every second": np.where(n % 2, np.nan, every),
            "repeated": every[new][np.searchsorted(new, n, side="right") - 1],
            "joined": np.round(np.interp(n, new, every[new]), 6),
        }[how]
        rows.to_csv(file, index=False)
    if not stated:
        toml = folder / "campaign.toml"
        toml.write_text(toml.read_text(encoding="utf-8").replace(f"yaw_rate = {NOISE}\n", ""), encoding="utf-8")
    return folder


@pytest.mark.parametrize("how", HOW)
def test_its_noise_is_found(tmp_path, how):
    campaign = read(slower(tmp_path / "campaign", how, stated=False))
    assert "yaw_rate" in campaign.noise_estimated
    assert campaign.noise["yaw_rate"] == pytest.approx(NOISE, rel=0.1)


@pytest.mark.parametrize("how", HOW)
def test_its_error_is_at_the_floor(tmp_path, how):
    """By a model with what was hidden; noise that was taken for a hundredth is found to be as large as it is."""
    campaign = read(slower(tmp_path / "campaign", how))
    likelihood = Likelihood(campaign, Variant().with_effects(["rolling_resistance_asymmetry"]).with_values(FITTED))
    evidence = likelihood.evidence(campaign.holdout, FITTED, tune_start=2)
    assert evidence.rms == pytest.approx(1, abs=0.05)
    assert all(e.rms["yaw_rate"] == pytest.approx(1, abs=0.12) for e in evidence.runs)
    taken = NoiseModel({**campaign.noise, "yaw_rate": NOISE / 100})
    noise_model, notes = noise_model_of(likelihood.with_noise_model(taken).evidence(campaign.holdout, FITTED), taken.sd, taken)
    assert noise_model.sd["yaw_rate"] == pytest.approx(NOISE, rel=0.15) and len(notes) == 1


@pytest.mark.nightly
@pytest.mark.parametrize("how", HOW)
@pytest.mark.parametrize("stated", [True, False])
def test_the_verdict_is_the_same(tmp_path, how, stated):
    found = diagnose(read(slower(tmp_path / "campaign", how, stated)))
    assert found.verdict == "missing" and found.effects == ("rolling_resistance_asymmetry",)
    assert found.ladder[-1].heldout == pytest.approx(1, abs=0.03)
    size = found.final.values["effect.rolling_resistance_asymmetry.D"]
    assert size == pytest.approx(1.6066, abs=0.05)


def test_a_campaign_is_as_before_where_each_row_has_a_reading():
    campaign: Campaign = read(SAMPLE)
    assert all(np.isfinite(series).all() for run in campaign.runs for series in run.channels.values())
