"""The campaigns of another simulator beside the project: what is hidden in them is named, and nothing that is not."""

from __future__ import annotations

import json

import pytest

from wheelchair_fmu.inference.decision.verdict import diagnose

from .conftest import MEASUREMENTS, measured

QUICK = ("open-00-null", "open-01-relaxation", "open-06-left-drag", "open-07-cm-offset")
LONG = (
    "open-02-crossfall",
    "open-03-camber",
    "open-04-scrub",
    "open-05-caster-friction",
    "open-08-straight-only",
    "open-10-slow-null",
    "open-11-trunk",
)
CASTERS = {"caster_trail", "caster_inertia"}  # which every chair of that simulator has


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.nightly) for name in LONG)])
def test_what_is_hidden_is_named(name):
    campaign = measured(name)
    truth = json.loads((MEASUREMENTS / "answers.json").read_text(encoding="utf-8"))[name]
    found = diagnose(campaign)
    named = {*found.effects, *(effect for tie in found.ties for effect in tie)}
    hidden = {truth["answer"]} if truth["answer"] else set()
    assert hidden <= named <= hidden | {*truth["also"]} | CASTERS
    assert found.verdict in ("missing", "tie") if hidden else found.verdict != "outside"
