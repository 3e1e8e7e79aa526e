"""Effects of a user's own in a sweep: they go wherever the work goes, and a changed one makes another sweep."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.chunks import complete, dask, here
from wheelchair_fmu.errors import Failure
from wheelchair_fmu.model.expression import effect_file
from wheelchair_fmu.quantities import N_S_M
from wheelchair_fmu.studies.sweep import Job, prepare, read_plan

PLAN = """
[parameters]
"effect.my_drag.q" = [0, 2, 4]
"resistance.f_r" = [0]
"resistance.f_f" = [0]
[[manoeuvre]]
name = "coast-down"
time = 4
"""


def write(folder: Path, expression: str) -> None:
    folder.mkdir(exist_ok=True)
    text = effect_file("my_drag", "viscous drag", "F_x", N_S_M, expression, size=0.5, lower=0.0, upper=100.0, source="chosen")
    (folder / "my_drag.py").write_text(text, encoding="utf-8")


@pytest.fixture
def place(tmp_path):
    """A folder with a plan and an effect."""
    (tmp_path / "plan.toml").write_text(PLAN)
    write(tmp_path / "effects", "-q * u")
    return tmp_path


def job_of(place: Path, **changes) -> Job:
    return Job(read_plan(place / "plan.toml", place / "effects"), **changes)


@pytest.mark.parametrize("engine", ["kernel", pytest.param("fmu", marks=pytest.mark.nightly)])
def test_a_drag_of_ones_own_slows_the_chair_as_it_says(place, engine):
    table = job_of(place, engine=engine).table(0).to_pandas()
    np.testing.assert_allclose(table.speed_end, np.exp(-table["effect.my_drag.q"] * 4 / 80), rtol=1e-5)


def test_workers_need_not_see_the_folder(place):
    job = job_of(place, chunk=1)
    shutil.rmtree(place / "effects")
    complete(job, place / "out.parquet", here(2))
    assert pd.read_parquet(place / "out.parquet").speed_end.is_monotonic_decreasing


def test_nor_need_those_of_a_dask_cluster(place):
    LocalCluster = pytest.importorskip("distributed").LocalCluster
    job = job_of(place, chunk=1)
    shutil.rmtree(place / "effects")
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None) as cluster:
        complete(job, place / "out.parquet", dask(cluster.scheduler_address))
    assert pd.read_parquet(place / "out.parquet").speed_end.is_monotonic_decreasing


def test_what_this_process_has_compiled_is_not_compiled_again(place, monkeypatch):
    """Kernels are known by the text of the effects, wherever it was read."""
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(place / "cache"))
    job = job_of(place, chunk=1)
    prepare(job)
    before = {file: file.stat().st_mtime_ns for file in (place / "cache").iterdir()}
    shutil.rmtree(place / "effects")
    complete(job, place / "out.parquet", here(1))
    assert {file: file.stat().st_mtime_ns for file in (place / "cache").iterdir()} == before


def test_a_changed_effect_is_another_sweep(place):
    first, out = job_of(place, chunk=1), place / "out.parquet"

    def stops(job, numbers):
        yield 0, job.table(0)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        complete(first, out, stops)
    assert job_of(place, chunk=1).fingerprint == first.fingerprint
    write(place / "effects", "-q * u * u / 1 [m/s]")
    with pytest.raises(Failure, match="parts of another plan, effects, engine or version"):
        complete(job_of(place, chunk=1), out, here(1))
    changed = job_of(place).table(0).to_pandas()  # quadratic: u = 1 / (1 + q t / m)
    np.testing.assert_allclose(changed.speed_end, 1 / (1 + changed["effect.my_drag.q"] * 4 / 80), rtol=1e-5)
