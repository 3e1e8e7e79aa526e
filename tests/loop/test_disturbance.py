"""The strength of forces that nobody recorded: what was put in comes out, and nothing where nothing was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.loop.disturbance import strength
from wheelchair_fmu.loop.evidence import LASTING, Bench
from wheelchair_fmu.model.variant import Variant

T_R = 0.55


def wandering(rng, time, sd):
    """A first-order Gauss–Markov process (n,) that is forgotten over LASTING seconds."""
    out, level = np.empty(len(time)), sd * rng.standard_normal()
    for i, gap in enumerate(np.diff(time, prepend=time[0])):
        keeps = np.exp(-gap / LASTING)
        level = keeps * level + np.sqrt(1 - keeps**2) * sd * rng.standard_normal()
        out[i] = level
    return out


def ridden(sample, rng, force, moment):
    """The sample's runs as the model has them, with noise, and with a force and a moment that no record has."""
    bench, runs = Bench(sample, Variant()), []
    for run in sample.runs:
        F, M = wandering(rng, run.time, force), wandering(rng, run.time, moment)
        felt = {"push.F_rl": run.inputs["push.F_rl"] + F / 2 + M / T_R, "push.F_rr": run.inputs["push.F_rr"] + F / 2 - M / T_R}
        pushed = replace(run, inputs={**run.inputs, **felt})
        names, _, true = bench.readings(pushed, {}, bench.starts[run.name])
        read = {c: v + rng.normal(0, sample.noise[c], len(v)) for c, v in zip(names, true.T, strict=True)}
        record = {n: w + rng.normal(0, 0.4, len(w)) for n, w in run.inputs.items()}
        runs.append(replace(run, inputs=record, channels=read))
    return replace(sample, runs=tuple(runs))


@pytest.mark.parametrize(("force", "moment"), [(3.0, 0.5), (0.0, 0.4), (0.0, 0.0)])
def test_the_force_that_was_put_in_comes_out(sample, force, moment):
    campaign = ridden(sample, np.random.default_rng(5), force, moment)
    evidence = Bench(campaign, Variant()).evidence(campaign.runs, {}, ())
    found = strength(evidence, T_R)
    assert found.force == pytest.approx(force, rel=0.15, abs=0.15)
    assert found.moment == pytest.approx(moment, rel=0.15, abs=0.03)
    noise = found.put_into(Bench(campaign, Variant()).colour)
    whole = Bench(campaign, Variant(), noise).evidence(campaign.runs, {}, ())
    assert float(np.mean(whole.r**2)) == pytest.approx(1, abs=0.03)
