"""Laws of a user's own inside a variant's file: they go along, are read to the letter, and run once somebody trusts them."""

from __future__ import annotations

import json
import os
import pickle
import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import casadi as cs
import numpy as np
import pandas as pd
import pytest
from fmpy import simulate_fmu

from tests.pages import BLOCK, ROOT, page, with_example
from wheelchair_fmu.contracts.own import untrusted, variant_in
from wheelchair_fmu.errors import EffectError, Failure, UsageError
from wheelchair_fmu.model.choice import Choice, OwnLaw, names
from wheelchair_fmu.model.recipe import Recipe
from wheelchair_fmu.model.variant import Variant, read_variant, variant_text

PAGE = "your-own-law.md"
TEXT = dict(BLOCK.findall(page(PAGE)))["laws/tyre/brush.py"]
ONE_MORE = TEXT.replace(
    "LAW = Alternative(",
    "from ...quantities import ONE, Parameter\n"
    'K = Parameter("tyre.brush", ONE, "its size", default=1.0, lower=0.0, upper=2.0)\n'
    "LAW = Alternative(",
).replace("brush_torque))", "brush_torque), (K,))")


@pytest.fixture(autouse=True)
def nothing_trusted(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))


def chair(text: str = TEXT) -> Variant:
    return Variant(Choice(tyre="brush", own=(OwnLaw("tyre", "brush", text, "brush.py"),)))


def written(folder: Path, variant: Variant) -> Path:
    (folder / "theirs.toml").write_text(variant_text(variant), encoding="utf-8")
    return folder / "theirs.toml"


def forces(variant: Variant) -> np.ndarray:
    """Lateral forces of both rear tyres in a sharp motion."""
    model = variant.model()
    at = cs.Function("F_s", [model.x, model.w, model.p], [model.quantities["F_s"]])
    x = np.zeros(model.x.numel())
    x[3:6] = 1.0, 0.2, 0.5
    return at(x, [i.start for i in model.inputs], variant.vector()).full().ravel()


def test_it_is_read_as_it_was_written_and_gives_the_same_forces(tmp_path):
    file = written(tmp_path, chair())
    assert TEXT in file.read_text(encoding="utf-8")
    again = variant_in(file, trust=True)
    assert again == chair() and variant_text(again) == variant_text(chair())
    assert names(again.choice)["tyre"] == (*names()["tyre"], "brush") and "brush" not in names()["tyre"]
    np.testing.assert_array_equal(forces(again), forces(chair()))
    assert abs(forces(again) - forces(Variant())).min() > 1.0


def test_it_is_refused_until_somebody_trusts_it(tmp_path):
    file = written(tmp_path, chair())
    with pytest.raises(Failure, match="carries the tyre law brush, a program that runs with your rights; read it there"):
        variant_in(file)
    assert list(untrusted(file)) == ["tyre law brush"]
    with pytest.raises(Failure, match="carries the tyre law brush, and programs are not run here"):
        read_variant(file)


def test_one_that_breaks_a_contract_is_refused_however_trusted(tmp_path):
    file = written(tmp_path, chair(TEXT.replace("return 3 * cs.fmax", "return -3 * cs.fmax")))
    with pytest.raises(EffectError, match="tyre law brush, passive: "):
        variant_in(file, trust=True)


@pytest.mark.parametrize(
    ("was", "becomes", "says"),
    [
        (
            "[own_laws.tyre.brush]",
            "[own_laws.tyre.dugoff]",
            "it carries a tyre law 'dugoff', and the package has one of that name",
        ),
        (
            "[own_laws.tyre.brush]",
            "[own_laws.spokes.brush]",
            r"own_laws holds tyre, caster, wheel laws; write \[own_laws.tyre.my_law\]",
        ),
        ("treads that bend", "treads that break", "the source of brush was changed after it was written"),
        ('tyre = "brush"', 'tyre = "brushes"', "no tyre law 'brushes'; did you mean 'brush'"),
    ],
)
def test_what_was_not_written_so_is_refused(tmp_path, was, becomes, says):
    file = written(tmp_path, chair())
    file.write_text(file.read_text(encoding="utf-8").replace(was, becomes), encoding="utf-8")
    with pytest.raises(UsageError, match=says):
        variant_in(file, trust=True)


def test_its_parameters_are_the_chair_s(tmp_path):
    variant = chair(ONE_MORE).with_values({"tyre.brush": 0.5, "tyre.law": "dugoff"})
    again = variant_in(written(tmp_path, variant), trust=True)
    assert again.values == {"tyre.brush": 0.5} and again.choice.tyre == "dugoff"
    with pytest.raises(UsageError, match=r"tyre\.brush = 3 is outside its bounds 0 to 2"):
        again.with_values({"tyre.brush": 3})


def test_it_goes_to_other_processes():
    recipe = Recipe.of(chair())
    code = "import pickle, sys; print(pickle.load(sys.stdin.buffer).variant().model().choice.tyre)"
    done = subprocess.run([sys.executable, "-c", code], input=pickle.dumps(recipe), capture_output=True, cwd=ROOT)
    assert done.stdout.decode().strip() == "brush", done.stderr.decode()


def test_another_text_is_another_chair():
    assert chair() != chair(ONE_MORE) and repr(chair().choice) != repr(chair(ONE_MORE).choice)
    assert chair() == replace(chair(), choice=replace(chair().choice, own=(OwnLaw("tyre", "brush", TEXT, "elsewhere.py"),)))


def wheelchair(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "WHEELCHAIR_CONFIG": str(folder / "config")}
    command = [sys.executable, "-m", "wheelchair_fmu", *words]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)


SAVE = "import wheelchair_fmu as wc; wc.Variant({'tyre.law': 'brush', 'tyre.mu': 0.8}).save('better.toml')"


@pytest.fixture
def saved(tmp_path) -> Path:
    """A folder with a configuration that has the page's law, and with a variant that was saved there."""
    with_example(PAGE, tmp_path)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "WHEELCHAIR_CONFIG": str(tmp_path / "config")}
    subprocess.run([sys.executable, "-c", SAVE], cwd=tmp_path, env=environment, check=True)
    return tmp_path


def test_a_law_of_the_configuration_goes_along(saved):
    assert untrusted(saved / "better.toml") == {}  # it has run here
    assert variant_in(saved / "better.toml") == chair().with_values({"tyre.mu": 0.8})


@pytest.mark.nightly
def test_and_is_needed_there_no_more(saved):
    turn = ("linearize", "--speed", "1", "--delta-force", "30", "--variant", "better.toml", "--json")
    there = wheelchair(saved, *turn)
    shutil.rmtree(saved / "config")
    here = wheelchair(saved, *turn)
    assert here.returncode == there.returncode == 0, here.stderr + there.stderr
    assert json.loads(here.stdout)["trim"] == json.loads(there.stdout)["trim"]
    shutil.rmtree(saved / "cache")  # another machine
    refused = wheelchair(saved, *turn)
    assert refused.returncode == 1 and "carries the tyre law brush" in refused.stderr
    assert wheelchair(saved, "trust", "better.toml").stdout.startswith("tyre law brush is trusted (sha256 ")
    checked = wheelchair(saved, "laws", "check", "--variant", "better.toml")
    assert checked.stdout == "tyre law brush: keeps every contract that the bundled laws keep\n", checked.stderr


PLAN = """
[parameters]
"tyre.law" = ["linear", "brush"]
[[manoeuvre]]
name = "slalom"
delta_force = 40
time = 2
[[variant]]
file = "theirs.toml"
"""


@pytest.mark.nightly
def test_fmus_systems_and_sweeps_have_it_by_the_variant_alone(tmp_path):
    written(tmp_path, chair())
    (tmp_path / "plan.toml").write_text(PLAN, encoding="utf-8")
    assert wheelchair(tmp_path, "trust", "theirs.toml").returncode == 0
    commands = (
        ("build", "--variant", "theirs.toml", "-o", "own.fmu"),
        ("build", "--variant", "theirs.toml", "-o", "python.fmu", "--flavour", "python"),
        ("ssp", "build", "ramp", "--variant", "theirs.toml", "-o", "own.ssp"),
        ("simulate", "slalom", "--time", "2", "--delta-force", "40", "--variant", "theirs.toml"),
        ("sweep", "plan.toml", "-o", "kernel.parquet"),
        ("sweep", "plan.toml", "-o", "fmu.parquet", "--engine", "fmu"),
    )
    for command in commands:
        done = wheelchair(tmp_path, *command)
        assert done.returncode == 0, (command, done.stderr)
    with zipfile.ZipFile(tmp_path / "own.fmu") as archive:
        assert '<Item name="brush"' in archive.read("modelDescription.xml").decode()
    kernel, fmu = (pd.read_parquet(tmp_path / f"{name}.parquet") for name in ("kernel", "fmu"))
    np.testing.assert_allclose(kernel["slip_peak_rr"], fmu["slip_peak_rr"], rtol=1e-5)
    assert kernel["slip_peak_rr"].nunique() == 2
    run = [
        simulate_fmu(str(tmp_path / f"{name}.fmu"), stop_time=0.5, start_values={"start.v": 0.2}) for name in ("own", "python")
    ]
    np.testing.assert_allclose(run[0]["chair.psi"], run[1]["chair.psi"], atol=1e-9)
