"""The paper's study: its measures on paths whose answers are known, and its statements through the FMU."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.handling.trim import Chair, trim
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice
from wheelchair_fmu.studies import Fmu, Result, fmu_of
from wheelchair_fmu.studies.paper import FIGURES, STATEMENTS, OpenValue, Range, Runs, Setting, ranges, statements
from wheelchair_fmu.studies.paper.runs import camber, scaled

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture(scope="module")
def papers():
    with Fmu(fmu_of(Variant(Choice(equations="paper")))) as driven:
        yield Runs(driven)


@pytest.mark.parametrize("statement", STATEMENTS, ids=lambda s: s.id)
def test_it_holds_as_the_docs_say(papers, statement):
    finding = statement.measure(papers)
    assert finding.holds
    row = f"| {statement.where} | {statement.says} | {finding.figure} | yes |"
    assert row in (DOCS / "paper.md").read_text(encoding="utf-8")


def test_all_hold_for_the_extended_equations_too(fmu):
    runs = Runs(fmu)
    assert [s.id for s in STATEMENTS if not s.measure(runs).holds] == []


def test_a_statement_can_fail(papers):
    strong = Runs(papers.fmu, Setting(delta_force=60.0))
    assert not statements.slip_below_one_degree(strong).holds
    without = Runs(papers.fmu, Setting(values={"tyre.C_phi": 0.0, "tyre.C_m_phi": 0.0}))  # camber does nothing
    for measure in ("camber_tightens_the_turn", "camber_makes_the_slalom_drift", "camber_shifts_slips"):
        assert not getattr(statements, measure)(without).holds


def test_the_turns_radius_is_that_of_the_trim(papers):
    for name in ("tyre.C_lambda", "tyre.C_m_lambda"):
        values = scaled(name, 2.0)
        steady = trim(Chair(Variant(Choice(equations="paper")).with_values(values)), 1.0, 10.0)
        assert statements.radius(papers.turn(values)) == pytest.approx(steady.radius, rel=1e-6)


def test_what_section_5_neglects_is_as_the_docs_say():
    rows = re.findall(r"^\|.*\| `(effect\S+)=(\S+)` \| (\S+) m \| (\S+) % \|$", (DOCS / "paper.md").read_text("utf-8"), re.M)
    assert len(rows) == 3
    without = trim(Chair(Variant()), 1.0, 10.0).radius
    for name, value, radius, moved in rows:
        found = trim(Chair(Variant().with_values({name: float(value)})), 1.0, 10.0).radius
        assert f"{found:.3f}" == radius
        assert 100 * (found / without - 1) == pytest.approx(float(moved.replace("−", "-")), abs=0.05)


def test_width_and_advance_of_a_slanted_wave():
    """A wave of half width 0.3 along a line at 30°, three periods of 2 m."""
    s = np.linspace(0, 6, 3001)
    along, across = s, 0.3 * np.sin(np.pi * s)
    c, n = np.cos(np.pi / 6), np.sin(np.pi / 6)
    run = Result(s, {"chair.x": along * c - across * n, "chair.y": along * n + across * c}, {})
    runs = Runs(None)  # type: ignore[arg-type]  # measures read results only
    assert statements.width(runs, run) == pytest.approx(0.3, rel=1e-4)
    assert statements.advance(runs, run) == pytest.approx(2.0, rel=1e-9)


def test_runs_are_done_once(papers, monkeypatch):
    papers.slalom(camber(0.5))
    monkeypatch.setattr(papers.fmu, "run", None)  # calling it would fail
    assert papers.slalom(camber(0.5)) is papers.slalom(camber(0.5))


def test_every_figure_has_three_lines(papers):
    assert [f.number for f in FIGURES] == list(range(12, 20))
    for figure in FIGURES:
        lines = figure.lines(papers)
        assert len(lines) == 3
        assert len({run["chair.y"][-1] for run in lines.values()}) == 3, figure.title
        assert (DOCS / "paper" / f"fig-{figure.number}.svg").is_file()


def test_a_range_reaches_to_the_first_break_on_either_side():
    value = OpenValue("x", "x", "N", (1, 2, 3, 4, 5), 3)
    assert Range(value, (False, True, True, True, False)).around == (2, 4)
    assert str(Range(value, (True, False, True, True, True))) == "3 to 5"
    assert Range(value, (True, True, False, True, True)).around is None
    assert str(Range(value, (True,) * 5)) == "all"


def test_ranges_vary_one_open_value_at_a_time(papers, monkeypatch):
    value = OpenValue("delta_force", "ΔF", "N", (2, 10, 60), 10)
    monkeypatch.setattr("wheelchair_fmu.studies.paper.open_values.OPEN", (value,))
    ((which, found),) = ranges(papers.fmu)
    assert which is value and found.keys() == {s.id for s in STATEMENTS}
    assert found["slip-1-degree"].held == (True, True, False) and found["camber-limited"].held == (False, True, True)
    assert found["radius-cornering"].around == (2, 60)


def test_a_setting_keeps_what_it_has():
    setting = replace(Setting(), period=3.0).but("tyre.C_m_phi", 1.0).but("delta_force", 4.0)
    assert setting == Setting(4.0, 3.0, 1.0, {"tyre.C_m_phi": 1.0})
