"""A campaign too large to be searched at once."""

from __future__ import annotations

import gc
from dataclasses import replace
from weakref import ref

import numpy as np
import pytest

from wheelchair_fmu.api import comparing
from wheelchair_fmu.campaign import pieces, windows
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.inference.residual.compare import Comparison, errors_of, together
from wheelchair_fmu.inference.search.recordings import Taken
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import REGIMES


@pytest.mark.nightly
def test_a_diagnosis_by_windows_finds_the_same_and_says_so(sample):
    """Runs of 11 to 15 s are windows of their own; of these, most."""
    chosen = windows(sample, most=4500)
    assert len(chosen.runs) < len(sample.runs)
    found = diagnose(chosen)
    assert found.effects[0] == "rolling_resistance_asymmetry" and found.ladder[-1].heldout < 1.05 < found.ladder[1].heldout
    assert found.notes[0] == chosen.thinned and "too many to search at once" in chosen.thinned


def test_a_heading_that_a_run_states_is_where_it_starts(sample):
    run = replace(sample.runs[0], set={"start.psi": 0.7})
    likelihood = Likelihood(replace(sample, runs=(run,)), Variant())
    assert likelihood.begins[run.name].start["start.psi"] == 0.7


def test_pieces_compared_are_the_run_compared(sample):
    """Each piece starts anew, so its errors are its own; put together they are those of all pieces."""
    run = next(r for r in sample.runs if r.name == "slalom-slow")
    parts = pieces(run, 4.0)
    likelihood = Likelihood(replace(sample, runs=tuple(parts)), Variant())
    outputs = likelihood.variant.model().outputs
    errors = [errors_of(e, None, REGIMES, outputs) for e in likelihood.evidence(parts, {}, tune_start=1).runs]
    whole = together(run.name, errors)
    assert len(parts) == 3 and whole.name == run.name and whole.e.shape == (len(run.time), len(run.channels))
    squares = sum(float(np.nansum(e.e**2)) for e in errors)
    assert Comparison((whole,)).rms() == pytest.approx(np.sqrt(squares / np.isfinite(whole.e).sum()), rel=1e-6)
    assert Comparison((whole,)).rms("fit") == pytest.approx(Comparison(tuple(errors)).rms("fit"), rel=1e-6)
    for name in REGIMES:
        assert whole.regime[name] == pytest.approx(np.concatenate([e.regime[name] for e in errors]), rel=1e-6, abs=1e-6)
    assert together(run.name, errors[:1]) is errors[0]


def test_what_is_made_of_a_piece_is_forgotten_once_it_is_compared(sample, monkeypatch):
    """However many pieces a campaign has, no more are prepared for a filter at once than are worked on: a kept one has several
    times as many bytes a sample as its errors have."""
    prepared, at_once, recorded = [], [], Likelihood._recorded

    def counted(likelihood, run):
        made = recorded(likelihood, run)
        prepared.append(ref(made))
        gc.collect()
        at_once.append(sum(one() is not None for one in prepared))
        return made

    monkeypatch.setattr(Likelihood, "_recorded", counted)
    monkeypatch.setattr(comparing, "AT_ONCE", 1)
    monkeypatch.setattr(comparing, "PIECE", 5.0)
    found = list(comparing._through_fmu(Taken(sample, NoiseModel(sample.noise)), Variant(), {}, lambda words: None))
    assert len(found) == len(sample.runs) < len(at_once)
    assert max(at_once) <= 2 * comparing.AT_ONCE  # a batch, and the one before it, which may not have ended yet


def test_errors_of_a_run_keep_no_result_of_its_simulation(sample):
    """A column of all results would keep them all."""
    likelihood = Likelihood(sample, Variant())
    (evidence,) = likelihood.evidence(sample.runs[:1], {}).runs
    errors = errors_of(evidence, None, REGIMES, likelihood.variant.model().outputs)
    assert not any(np.shares_memory(errors.regime[name], evidence.results) for name in REGIMES)
