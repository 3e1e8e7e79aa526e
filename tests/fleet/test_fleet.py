"""Campaigns side by side: a row for each, a fault is a row too, nothing is diagnosed twice."""

from __future__ import annotations

import pickle
import shutil
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from wheelchair_fmu.chunks import complete, dask, is_done
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.errors import Failure
from wheelchair_fmu.fleet import Fleet, folders
from wheelchair_fmu.fleet.rows import SE
from wheelchair_fmu.model.effects import bundled, defined, sources
from wheelchair_fmu.model.recipe import Recipe
from wheelchair_fmu.model.variant import Variant

K = "effect.aerodynamic_drag.k"
RIVALS = {"aerodynamic_drag", "rolling_resistance_speed"}


def wheelchair(*words):
    return CliRunner().invoke(app, [str(w) for w in words])


@pytest.fixture(scope="module")
def diagnosed(garage, tmp_path_factory):
    """What the command said of the fleet, and its table."""
    out = tmp_path_factory.mktemp("out") / "fleet.csv"
    done = wheelchair("fleet", garage, "-o", out, "--workers", 1)
    assert done.exit_code == 0, done.output
    return done, out


def test_each_chair_has_a_row_and_the_faulty_one_its_fault(garage, diagnosed):
    done, out = diagnosed
    table = pd.read_csv(out).set_index("campaign")
    assert list(table.index) == ["a", "b", "c"] and list(table.folder) == [str(garage / name) for name in "abc"]
    good, bad = table.loc[["a", "c"]], table.loc["b"]
    assert good.verdict.isin(["missing", "tie"]).all() and good.error.isna().all()
    assert all(RIVALS & set(effects.split(", ")) for effects in good.effects)
    assert (good.rms_holdout < 1.1).all() and (good.rms_holdout_calibrated > good.rms_holdout).all()
    assert (good[K] > 0.2).all() and (good[K + SE] < 0.2).all()  # hidden: 0.8 N s²/m²
    assert "campaign.toml line" in bad.error and "(and 2 more; see wheelchair check" in bad.error and bad[[K]].isna().all()
    assert "1 of 3 campaigns were not diagnosed" in done.stderr


def test_effects_and_summary_stand_beside_it(diagnosed):
    done, out = diagnosed
    assert sorted(f.name for f in out.parent.iterdir()) == [
        "fleet-effects.csv",
        "fleet-summary.csv",
        "fleet.csv",
        "fleet.parquet",
    ]
    effects, together = (pd.read_csv(out.with_name(f"fleet-{kind}.csv")) for kind in ("effects", "summary"))
    assert set(effects.campaign) == {"a", "c"} and RIVALS & set(effects.effect)
    air = together.set_index("parameter").loc["k"] if together.parameter.is_unique else together.iloc[0]
    assert air.missing + air.tied == 2 and air.share == 1.0 and air.n == 2
    assert "what 2 chairs lack" in done.stdout
    schema = pq.read_schema(out.with_suffix(".parquet"))
    assert schema.field(K).metadata[b"unit"] == b"N.s2/m2"


def test_only_what_has_changed_is_diagnosed_again(garage, diagnosed, tmp_path):
    """The fault is mended, and a chair joins: the two rows that were there are taken over."""
    shutil.copytree(garage, tmp_path / "garage")
    row, out, asked = pd.read_parquet(diagnosed[1].with_suffix(".parquet")).iloc[:1], tmp_path / "out.parquet", []

    def pool(job, numbers):
        """Instead of diagnosing, says the same of all."""
        for n in numbers:
            asked.append(n)
            yield n, pa.Table.from_pandas(row.assign(key=job.keys[n]), schema=job.schema())

    first = Fleet(folders([tmp_path / "garage"]))
    complete(first, out, pool)
    assert asked == [0, 1, 2] and is_done(first, out)
    shutil.copyfile(garage / "a" / "campaign.toml", tmp_path / "garage" / "b" / "campaign.toml")
    then = Fleet(folders([tmp_path / "garage", garage / "c"]))
    assert not is_done(then, out)
    complete(then, out, pool, known=then.known(out))
    assert asked == [0, 1, 2, 1, 3] and is_done(then, out) and tuple(pd.read_parquet(out).key) == then.keys
    assert not Fleet(then.places, settings=(("chair.m", "81"),)).known(out)


@pytest.mark.nightly
def test_a_dask_cluster_gives_the_same_bytes(garage, diagnosed, tmp_path):
    LocalCluster = pytest.importorskip("distributed").LocalCluster
    job, out = Fleet(folders([garage])), tmp_path / "out.parquet"
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None) as cluster:
        complete(job, out, dask(cluster.scheduler_address))
    assert out.read_bytes() == diagnosed[1].with_suffix(".parquet").read_bytes()


def test_ones_own_effects_and_variant_go_with_the_work(tmp_path):
    """Whoever diagnoses need not see their files, but the row's key knows them."""
    assert wheelchair("effects", "new", "my_drag", "-o", tmp_path).exit_code == 0
    own = sources(tmp_path)
    heavy = Variant(catalogue={**bundled(), **defined(own)}).with_effects(["my_drag"]).with_values({"chair.m": "95"})
    job = Fleet((tmp_path,), (("effect.my_drag.q", "2"),), Recipe.of(heavy))
    shutil.rmtree(tmp_path)
    there = pickle.loads(pickle.dumps(job)).chair()
    assert there.effects == ("my_drag",) and there.values == {"chair.m": 95.0, "effect.my_drag.q": 2.0}
    other = replace(job.recipe, own=tuple((file, f"{text}# another") for file, text in job.recipe.own))
    assert replace(job, recipe=other).keys != job.keys


def test_folders_are_campaigns_or_hold_them(garage, tmp_path):
    assert folders([garage / "c", garage]) == (garage / "c", garage / "a", garage / "b")
    with pytest.raises(Failure, match=r"no campaign\.toml in it or in a folder in it"):
        folders([tmp_path])


def test_a_worker_that_does_not_see_the_folder_says_so():
    with pytest.raises(Failure, match="the workers of a cluster must see the campaigns' folders"):
        Fleet((Path("/not/there"),)).table(0)


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (("-o", "out.xlsx"), 2, "give a name that ends in .parquet or .csv"),
        (("-o", "o.csv", "--set", "chair.mm=3"), 2, "no parameter 'chair.mm'"),
        (("-o", "o.csv", "--dask", "x", "--workers", 2), 2, "give one of them"),
        (("-o", "o.csv", "--variant", "none.toml"), 1, "none.toml: no such file"),
        ((), 2, "--output"),
    ],
)
def test_fleet_refuses_in_one_sentence(garage, tmp_path, monkeypatch, words, code, sentence):
    monkeypatch.chdir(tmp_path)
    done = wheelchair("fleet", garage, *words)
    assert done.exit_code == code and sentence in done.stderr and "Traceback" not in done.output
    assert not list(tmp_path.iterdir())
