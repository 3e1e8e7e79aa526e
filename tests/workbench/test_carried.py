"""Variants of a session that carry its effects: they stay usable where the effect was changed or the cache was emptied."""

from __future__ import annotations

from wheelchair_fmu.cli.effects import template
from wheelchair_fmu.contracts.own import untrusted
from wheelchair_fmu.workbench.session import Session


def test_a_session_trusts_what_it_has_written(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    session = Session.begin(tmp_path)
    session.write_effect("mine", template("force", "mine"))
    session.keep(session.variant().with_values({"effect.mine.q": 2.0}), "+ mine")
    assert untrusted(session.variant_file) == {}
    (session.effects / "mine.py").unlink()
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "emptied"))
    assert session.variant().values == {"effect.mine.q": 2.0}
    assert list(untrusted(session.variant_file)) == ["effect mine"]
    session.trust_variant()  # as before each job
    assert untrusted(session.variant_file) == {}
