"""What a search spares itself is to decide nothing."""

from __future__ import annotations

from dataclasses import fields

import pytest

from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.policy import USUAL, Effort, SearchPolicy


def test_every_number_has_its_reason_and_another_value_to_try():
    numbers = [*fields(SearchPolicy), *fields(Effort)]
    assert all(len(f.metadata["reason"]) > 20 for f in numbers)
    assert len(fields(SearchPolicy)) <= 15
    thorough = Effort.thorough()
    assert all(getattr(thorough, f.name) != getattr(USUAL, f.name) for f in fields(Effort))
    for policy in fields(SearchPolicy):
        low, high = policy.metadata["range"]
        assert low < policy.default < high


@pytest.mark.nightly
def test_a_search_that_spares_no_work_finds_the_same(sample):
    usual, thorough = diagnose(sample), diagnose(sample, effort=Effort.thorough())
    assert (thorough.verdict, thorough.effects, thorough.ties) == (usual.verdict, usual.effects, usual.ties)
    assert len(thorough.rounds[0].candidates) > len(usual.rounds[0].candidates)
