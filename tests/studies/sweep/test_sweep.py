"""Sweeps: right numbers by either engine, nothing lost or done twice, bad chairs told and passed over."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from wheelchair_fmu.chunks import bad, complete, dask, here, is_done
from wheelchair_fmu.chunks.parts import folder
from wheelchair_fmu.errors import Failure
from wheelchair_fmu.studies.sweep import Job, prepare, read_plan, running

from ...kit import descendants, gone

SMALL = """
[sweep]
method = "sobol"
samples = 8
[parameters]
"tyre.C_lambda" = { from = 2500, to = 10000, log = true }
"tyre.law" = ["linear", "magic_formula"]
[[manoeuvre]]
name = "slalom"
time = 2
[[manoeuvre]]
name = "start-stop"
time = 2
"""


def job_of(folder, text, **changes):
    (folder / "plan.toml").write_text(text)
    return Job(read_plan(folder / "plan.toml"), **changes)


def in_order(job, numbers):
    """The simplest pool."""
    for n in numbers:
        yield n, job.table(n)


def test_a_steady_turn_has_the_radius_of_the_trim(tmp_path):
    job = job_of(tmp_path, '[parameters]\n"chair.m" = [80]\n[[manoeuvre]]\nname = "steady-turn"\ntime = 10\n')
    row = job.table(0).to_pylist()[0]
    assert row["radius"] == pytest.approx(3.3018, rel=1e-4) and row["error"] is None and row["speed_end"] == 1.0
    assert row["manoeuvre"] == "steady-turn time=10" and row["manoeuvre.time"] == 10 and row["rms"] != row["rms"]


def test_without_resistance_the_pushes_work_becomes_motion(tmp_path):
    job = job_of(
        tmp_path,
        """
[parameters]
"resistance.f_r" = [0]
"resistance.f_f" = [0]
"chair.m" = [60, 90]
[[manoeuvre]]
name = "start-stop"
time = 4
""",
    )
    rows = job.table(0).to_pylist()
    assert [row["push_work"] for row in rows] == pytest.approx(
        [row["chair.m"] * row["speed_end"] ** 2 / 2 for row in rows], rel=1e-4
    )
    assert rows[0]["push_work"] > rows[1]["push_work"] > 10


def test_a_hands_off_chair_gets_no_work_and_a_straight_one_no_radius(tmp_path):
    row = job_of(tmp_path, '[[manoeuvre]]\nname = "coast-down"\n').table(0).to_pylist()[0]
    assert row["push_work"] == 0 and row["radius"] == np.inf and row["drift"] == pytest.approx(0, abs=1e-9)


def test_both_engines_give_the_same_numbers(tmp_path):
    tables = [job_of(tmp_path, SMALL, engine=engine).table(0).to_pandas() for engine in ("kernel", "fmu")]
    assert set(tables[0]["tyre.law"]) == {"linear", "magic_formula"}
    pd.testing.assert_frame_equal(*tables, rtol=1e-4, atol=1e-6)
    assert tables[0].error.isna().all()


def test_chairs_are_the_same_however_many_run_side_by_side(tmp_path, monkeypatch):
    text = SMALL.replace("samples = 8", "samples = 64").replace('"tyre.law" = ["linear", "magic_formula"]', "")
    job, by_two = job_of(tmp_path, text), job_of(tmp_path, text, chunk=4)
    together = job.table(0).to_pandas()
    assert len(together) == 128 and together.curvature.nunique() > 60
    monkeypatch.setattr(running, "NUMBERS", 1)  # so the least at once, which are several times as many
    pd.testing.assert_frame_equal(job.table(0).to_pandas(), together, check_exact=True)
    apart = pa.concat_tables([by_two.table(n) for n in range(by_two.chunks)]).to_pandas()
    pd.testing.assert_frame_equal(apart, together, check_exact=True)


@pytest.mark.parametrize("engine", ["kernel", "fmu"])  # in threads, and in processes
def test_two_at_once_do_what_one_does(tmp_path, engine):
    job = job_of(tmp_path, SMALL, chunk=4, engine=engine)
    assert job.by_threads == (engine == "kernel")
    complete(job, tmp_path / "one.parquet", in_order)
    prepare(job)
    seen: list[int] = []
    complete(job, tmp_path / "two.parquet", here(2), seen.append)
    one, two = (pd.read_parquet(tmp_path / f"{name}.parquet") for name in ("one", "two"))
    pd.testing.assert_frame_equal(one, two)
    assert sum(seen) == len(two) == 16 and list(two.chair) == sorted(two.chair)


def test_an_fmu_serves_several_threads(tmp_path):
    job = job_of(tmp_path, SMALL, chunk=4, engine="fmu")
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(job.table, range(job.chunks)))
    for n, table in enumerate(together):
        pd.testing.assert_frame_equal(table.to_pandas(), job.table(n).to_pandas(), check_exact=True)


def test_stopped_and_run_again_nothing_is_lost_or_done_twice(tmp_path):
    job, out, done = job_of(tmp_path, SMALL, chunk=4), tmp_path / "out.parquet", []

    def stops(job, numbers):
        for n, table in in_order(job, numbers):
            if len(done) == 2:
                raise KeyboardInterrupt
            done.append(n)
            yield n, table

    def goes_on(job, numbers):
        for n, table in in_order(job, numbers):
            done.append(n)
            yield n, table

    with pytest.raises(KeyboardInterrupt):
        complete(job, out, stops)
    assert not out.exists() and len(list(folder(out).glob("*.parquet"))) == 2
    told: list[int] = []
    complete(job, out, goes_on, told.append)
    assert sorted(done) == list(range(job.chunks)) and sum(told) == job.plan.runs
    complete(job, tmp_path / "whole.parquet", in_order)
    assert out.read_bytes() == (tmp_path / "whole.parquet").read_bytes()
    assert not folder(out).exists() and is_done(job, out)
    complete(job, out, None)  # done already: asking the pool would fail


def test_parts_of_another_plan_are_not_mixed_in(tmp_path):
    job, out = job_of(tmp_path, SMALL), tmp_path / "out.parquet"
    folder(out).mkdir()
    (folder(out) / "fingerprint").write_text("another")
    with pytest.raises(Failure, match="parts of another plan, effects, engine or version; remove this folder"):
        complete(job, out, in_order)
    assert not is_done(job, out)


def test_bad_chairs_are_told_and_not_fatal(tmp_path):
    (tmp_path / "paper.toml").write_text('[laws]\nequations = "paper"\n')
    job = job_of(
        tmp_path,
        """
[parameters]
"chair.m" = [60, 80]
[[manoeuvre]]
name = "slalom"
[[manoeuvre]]
name = "start-stop"
[[variant]]
file = "paper.toml"
""",
    )
    complete(job, tmp_path / "out.parquet", in_order)
    table = pd.read_parquet(tmp_path / "out.parquet")
    failed = table.manoeuvre == "start-stop"  # the paper divides by the forward speed
    assert table.error[failed].str.contains("the simulation stops at t = ").all() and table.error[~failed].isna().all()
    assert table.drift[failed].isna().all() and table.drift[~failed].notna().all()
    assert bad(tmp_path / "out.parquet")[0] == 2


def test_columns_say_their_units(tmp_path):
    job = job_of(tmp_path, SMALL)
    complete(job, tmp_path / "out.parquet", in_order)
    schema = pq.read_schema(tmp_path / "out.parquet")
    assert schema.field("tyre.C_lambda").metadata[b"unit"] == b"N/rad"
    assert schema.field("push_work").metadata[b"unit"] == b"J"


LONG = SMALL.replace("samples = 8", "samples = 4096").replace("time = 2", "time = 10")
LONG_ENOUGH = {"kernel": LONG.replace("4096", "16384"), "fmu": SMALL.replace("samples = 8", "samples = 1024")}


def command(folder, out, *words):
    return [sys.executable, "-m", "wheelchair_fmu", "sweep", str(folder / "plan.toml"), "-o", str(out), *words]


def wait_for_parts(out, n, process):
    while len(list(folder(out).glob("[0-9]*.parquet"))) < n:
        assert process.poll() is None, "it ended before it could be killed"
        time.sleep(0.02)


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="SIGKILL is POSIX")
@pytest.mark.parametrize("engine", list(LONG_ENOUGH))
def test_killed_outright_and_run_again(tmp_path, engine):
    job, out = job_of(tmp_path, LONG_ENOUGH[engine], engine=engine), tmp_path / "out.parquet"
    words = command(tmp_path, out, "--workers", "2", "--engine", engine)
    first = subprocess.Popen(words)
    wait_for_parts(out, 3, first)
    workers = descendants(first.pid)
    first.send_signal(signal.SIGKILL)
    first.wait()
    assert gone(workers, 30) and (workers or job.by_threads or not Path("/proc/self/stat").exists())
    kept = {file.name: file.stat().st_mtime_ns for file in folder(out).glob("[0-9]*.parquet")}
    again = subprocess.Popen(words)
    wait_for_parts(out, len(kept) + 1, again)
    assert all((folder(out) / name).stat().st_mtime_ns == at for name, at in kept.items())
    assert again.wait(120) == 0
    chairs = pd.read_parquet(out, columns=["chair", "manoeuvre"])
    assert len(chairs) == job.plan.runs and not chairs.duplicated().any() and is_done(job, out)


@pytest.mark.nightly
@pytest.mark.skipif(os.name == "nt", reason="SIGKILL is POSIX")
def test_a_dask_cluster_with_a_worker_killed_does_the_same(tmp_path):
    LocalCluster = pytest.importorskip("distributed").LocalCluster
    job, out = job_of(tmp_path, LONG), tmp_path / "out.parquet"
    prepare(job)
    with LocalCluster(n_workers=3, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None) as cluster:
        pool = dask(cluster.scheduler_address)
        killed = []

        def kills(job, numbers):
            for n, result in pool(job, numbers):
                if not killed:
                    killed.append(cluster.workers[0].pid)
                    os.kill(killed[0], signal.SIGKILL)
                yield n, result

        complete(job, out, kills)
        assert cluster.workers[0].pid != killed[0]
    chairs = pd.read_parquet(out)
    assert len(chairs) == job.plan.runs and not chairs.duplicated(["chair", "manoeuvre"]).any()
    pd.testing.assert_frame_equal(
        job.table(job.chunks - 1).to_pandas(), chairs.iloc[-job.rows(job.chunks - 1) :].reset_index(drop=True)
    )


def test_no_cluster_at_the_address(tmp_path):
    pytest.importorskip("distributed")
    with pytest.raises(Failure, match="no Dask cluster with a worker at tcp:"):
        complete(job_of(tmp_path, SMALL), tmp_path / "out.parquet", dask("tcp://127.0.0.1:9", 0.5))
