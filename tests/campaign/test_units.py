"""What is known of units without pint is what pint says."""

from __future__ import annotations

import pytest

from wheelchair_fmu import units


@pytest.mark.parametrize(("text", "si"), list(units.USUAL))
def test_usual_units_are_those_of_pint(text, si, monkeypatch):
    known = units.USUAL[text, si]
    monkeypatch.setattr(units, "USUAL", {})
    by_pint = units.factor.__wrapped__(text, si)
    assert known == pytest.approx(by_pint, rel=1e-15)


def test_dimensions_are_those_of_pint(monkeypatch):
    names = [si for text, si in units.SI_OF.items() if text == si]
    by_hand = {(text, si): units.same_dimension(text, si) for text in units.SI_OF for si in names}
    monkeypatch.setattr(units, "SI_OF", {})
    assert by_hand == {(text, si): units.same_dimension(text, si) for text, si in by_hand}
    assert 0 < sum(by_hand.values()) < len(by_hand)


def test_most_files_are_read_without_pint(monkeypatch):
    monkeypatch.setattr(units, "_parse", lambda text: pytest.fail("pint was asked"))
    units.factor.cache_clear()
    assert units.factor("deg/s", "rad/s") == pytest.approx(0.017453292519943295)
    assert units.factor("N", "N") == 1.0
    assert not units.same_dimension("m/s", "rad/s") and units.same_dimension("deg/s", "rad/s")
