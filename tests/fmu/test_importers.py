"""The importers that are not Python's FMPy, each in the environment that `make importers` sets up, and the tables of all."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.importers import page
from benchmarks.importers.cases import WET, cases
from benchmarks.importers.driving import OTHERS, on_fmu, on_ssp, plain_host
from benchmarks.importers.rows import FMU_HEAD, SLIDES, SSP_HEAD, STROKES, Row, fmu_rows, head, ssp_rows
from wheelchair_fmu.fmu.build import build
from wheelchair_fmu.studies import fmu_of

needs_others = pytest.mark.skipif(not OTHERS, reason="no $IMPORTERS_PYTHON: `make importers` sets it up")
ROWS = {"fmu": (*fmu_rows("2"), *fmu_rows("3")), "ssp": ssp_rows()}
NOT_THERE = {"libcosimpy": "3"}  # reads FMI 1.0 and 2.0 only


@pytest.mark.parametrize(("kind", "names"), [("fmu", FMU_HEAD), ("ssp", SSP_HEAD)])
def test_the_documentation_shows_every_row_with_a_result(kind, names):
    table = page.shown(kind)
    rows = page.cells(table)
    assert table.startswith(head(names))
    assert [(row[0], *row[2:-1]) for row in rows] == [row.key for row in ROWS[kind]]
    assert all(row[-1] for row in rows)


def _named(row: Row) -> str:
    return " ".join(row.key)


@pytest.mark.nightly
@pytest.mark.parametrize("row", [r for r in fmu_rows("2") if r.here and r.run == SLIDES], ids=_named)
def test_wheels_whose_spin_is_a_state_slide_in_an_importer_as_in_the_engine(row, native, tmp_path: Path):
    case = cases(native.path, tmp_path)[SLIDES]
    assert abs(case.expected["sensor.wheel_speed_l"]) < 1e-4 < 0.5 < case.expected["chair.u"]  # locked, and still moving
    result = on_fmu(row, fmu_of(WET, with_starts=True), case)
    assert result.good, result.verdict


@pytest.mark.nightly
@needs_others
@pytest.mark.parametrize("row", [r for r in ROWS["fmu"] if r.script and NOT_THERE.get(r.tool) != r.fmi], ids=_named)
def test_others_get_what_is_right(row, native, native3, tmp_path: Path):
    archive = (native if row.fmi == "2" else native3).path
    driven = build(WET, tmp_path / "wet.fmu", fmi=row.fmi) if row.run == SLIDES else archive
    result = on_fmu(row, driven, cases(archive, tmp_path)[row.run])
    assert result.good, result.verdict


@pytest.mark.nightly
@needs_others
@pytest.mark.parametrize("row", [r for r in ROWS["ssp"] if r.script], ids=_named)
def test_others_run_the_same_system(row, tmp_path: Path):
    from wheelchair_fmu.studies.ssp.building import build as build_system

    result = on_ssp(row, build_system(row.run, tmp_path / f"{row.run}.ssp"))
    assert result.good, result.verdict


@pytest.mark.nightly
@pytest.mark.parametrize("fmi", ["2", "3"])
def test_a_host_in_c_gets_what_the_engine_gives(fmi, native, native3, tmp_path: Path):
    row = next(r for r in fmu_rows(fmi) if r.run == STROKES)
    assert plain_host(row, (native if fmi == "2" else native3).path, tmp_path).good
