"""The supplement as files: tables that equal the diagnosis, figures for print, and what is refused."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from hashlib import sha256
from io import StringIO

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.errors import Failure
from wheelchair_fmu.faults import WARNING, Fault
from wheelchair_fmu.report.paper import tables
from wheelchair_fmu.report.paper.figures import forest_figure, residuals_figure
from wheelchair_fmu.report.paper.folder import supplement
from wheelchair_fmu.report.paper.left_out import left_out
from wheelchair_fmu.report.paper.replay import replay

from .case import SAMPLE, SIZE, case_of, sample, told
from .test_markup import well_formed
from .test_methods import CASES

TABLES = ("estimates.csv", "covariance.csv", "errors.csv", "left_out.csv")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("supplement")
    files = supplement(case_of(), place)
    assert sorted(files) == sorted(place.iterdir())
    return place


def test_every_file_is_there_and_the_readme_says_what_it_is(folder):
    readme = (folder / "README.md").read_text(encoding="utf-8")
    assert len([line for line in readme.splitlines() if line.startswith("- ")]) == 5
    for file in folder.iterdir():
        assert file.name == "README.md" or file.name in readme or f"`{file.stem}`" in readme, file.name


def test_estimates_and_covariance_are_those_of_the_last_fit(folder):
    final = told()["final"]
    found = pd.read_csv(folder / "estimates.csv", index_col="parameter")
    spread = pd.read_csv(folder / "covariance.csv", index_col="parameter")
    assert list(found.index) == list(spread.index) == list(spread.columns) == [p["name"] for p in final["parameters"]]
    assert np.sqrt(np.diag(spread)) == pytest.approx(found["se"].to_numpy(), rel=1e-8)
    assert found["estimate"].tolist() == pytest.approx([p["estimate"] for p in final["parameters"]], rel=1e-9)
    drag, mass = found.loc[SIZE], found.loc["chair.m"]
    assert (drag.interval, drag.kind, mass.interval, mass.kind) == (
        *("profile likelihood", "effect found"),
        *("standard errors", "calibrated value"),
    )
    assert (mass.lower_95 + mass.upper_95) / 2 == pytest.approx(mass.estimate) and (mass.prior, mass.prior_sd) == (80, 2)
    normal = 2 * 1.95996 * np.hypot(mass.se, mass.unnamed)  # and a little more, as runs that differ are few
    assert 1 - 1e-5 < (mass.upper_95 - mass.lower_95) / normal < 1.05
    assert mass.unnamed > 0 and not found["at_bound"].any()


def test_the_errors_are_those_of_the_staircase(folder):
    found = pd.read_csv(folder / "errors.csv").set_index(["step", "channel", "runs"])
    for step in told()["ladder"]:
        for key, runs in tables.RUNS.items():
            assert found.loc[(step["step"], "all", runs), "whitened_rms"] == pytest.approx(step[key])
            for channel, error in step["channels"].items():
                row = found.loc[(step["step"], channel, runs)]
                assert (row.whitened_rms, row.rms) == pytest.approx((error[key], error[f"{key}_rms"]))
                assert row.unit == error["unit"]


def test_latex_is_well_formed(folder):
    for name in ("methods.tex", "estimates.tex"):
        text = (folder / name).read_text(encoding="utf-8")
        well_formed(re.sub(r"(?<!\\)&", "", text))
    rows = [line for line in text.splitlines() if line.endswith(r"\\")]
    assert {len(re.findall(r"(?<!\\)&", row)) for row in rows} == {3}
    assert rows[1].startswith(r"\texttt{effect.rolling\_resistance\_asymmetry.D} & $1.605 \pm 0.008$ & $[1.486, 1.726]$")


def test_fingerprints_are_those_of_the_files(folder):
    found = json.loads((folder / "fingerprints.json").read_text(encoding="utf-8"))
    files = found["campaign"]["sha256"]
    assert len(files) == 11 and found["campaign"]["fingerprint"] == sample().fingerprint
    assert all(sha256((SAMPLE / name).read_bytes()).hexdigest() == digest for name, digest in files.items())
    assert {"numpy", "scipy", "casadi"} <= set(found["libraries"]) and len(found["catalogue"]) == len(case_of().chair.catalogue)
    assert found["diagnosis"] == told()["made_by"] and len(found["supplement"]["code"]) == 64


def test_figures_are_as_wide_as_a_page_with_fonts_inside(folder):
    for name in ("residuals", "estimates"):
        pdf = (folder / f"{name}.pdf").read_bytes()
        width = float(re.search(rb"/MediaBox \[ ?0 0 ([\d.]+)", pdf)[1])
        assert width == pytest.approx(170 / 25.4 * 72, abs=0.1) and b"FontFile2" in pdf
        svg = (folder / f"{name}.svg").read_text(encoding="utf-8")
        assert float(re.search(r'width="([\d.]+)pt"', svg)[1]) == pytest.approx(170 / 25.4 * 72, abs=0.1)


def test_residuals_are_shown_of_the_run_that_is_foretold_least():
    found = replay(case_of())
    worst = {c: e["runs"] for c, e in told()["physical"].items()}
    assert found.run == "holdout-strokes" and found.role == "holdout"
    rms = float(np.degrees(np.sqrt(np.nanmean(found.after["yaw_rate"] ** 2))))
    assert rms == pytest.approx(worst["yaw_rate"][found.run], rel=0.01)
    figure = residuals_figure(found, True)
    titles = [ax.get_title(loc="left") for ax in figure.axes[:2]]
    assert titles == ["holdout-strokes, as calibrated", "holdout-strokes, with the last model"] and len(figure.axes) == 10
    assert len(residuals_figure(found, False).axes) == 5


@pytest.mark.parametrize("name", ["an offset", "at a bound", "adequate", "no runs held out"])
def test_every_case_has_its_tables_and_its_forest(name):
    case = case_of(CASES[name])
    found = tables.estimates(case)
    well_formed(tables.estimates_tex(found).replace("&", ""))
    labels = [text.get_text() for ax in forest_figure(case).axes for text in ax.get_yticklabels()]
    assert sorted(labels) == sorted(n.removeprefix("effect.") for n in found.index)
    assert set(tables.errors(case)["runs"]) == ({"fitted"} if name == "no runs held out" else {"fitted", "held out"})
    if name == "at a bound":
        stopped = found.loc["chair.m"]
        assert stopped.at_bound and not stopped.interval and np.isnan(stopped.lower_95)


def test_nothing_left_out_is_a_header(folder):
    text = (folder / "left_out.csv").read_text(encoding="utf-8")
    assert text == "place,what,why,said_by,left_out\n"


def test_what_was_left_out_is_told_with_its_reason():
    note = "a_y has the other sign than the model's, and is left out; turn its column round"
    found = told(notes=[note, "m is odd"])
    runs = found["final"]["runs"]
    for run in runs.values():
        del run["channels"]["a_y"]
    runs["coast-down"]["channels"]["a_x"]["used"] -= 4
    runs["steady-left"]["from"] += 0.25
    spike = Fault("runs/x.csv", 30, "a_x [g]", "a_x reads 9 m/s2, alone, and is left out there", "none", WARNING)
    table = left_out(case_of(found, replace(sample(), warnings=(spike,))))
    assert table.iloc[0].tolist() == ["runs/x.csv line 30", "a_x [g]", spike.fact, "check", True]
    assert (table[table["what"] == "a_y"]["why"] == note).sum() == 10
    assert "a_x: 4 of 550 readings" in table["what"].tolist()
    (lost,) = (row for row in table.itertuples() if row.place == "steady-left" and row.what != "a_y")
    assert lost.what == "0.005 to 0.255 s (0.250 s)"
    assert table[~table["left_out"]]["why"].tolist() == ["m is odd"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d.pop("final"), "has no 'final', as earlier versions wrote it; diagnose the campaign again"),
        (lambda d: d.update(fingerprint="0" * 64), "its data are not those of 'sample-chair' as they are now"),
        (lambda d: d["final"].update(fixed={"chair.m": 80}), "was made with chair.m set by --set; give the same values"),
        (
            lambda d: d["final"]["parameters"][-1].update(name="effect.my_own.k"),
            "has the effect 'my_own', which is not in the catalogue; give its folder by --effects",
        ),
    ],
)
def test_another_diagnosis_is_refused_in_a_sentence(change, words):
    found = told()
    change(found)
    with pytest.raises(Failure, match=r"^d\.json: ") as met:
        case_of(found)
    assert words in str(met.value) and "\n" not in str(met.value)


def test_another_chair_is_noticed():
    found = told()
    found["models"][-1]["values"][SIZE] = 0.0
    with pytest.raises(Failure, match=r"leaves 1\.00 times the noise, and [\d.]+ times simulated again; give the --variant"):
        replay(case_of(found))


def test_a_table_can_be_read_back():
    text = tables.covariance(case_of()).to_csv(float_format="%.10g")
    assert pd.read_csv(StringIO(text), index_col=0).shape == (9, 9)


def test_a_run_whose_name_begins_as_another_s_is_no_piece_of_it():
    case = case_of()
    run = next(r for r in case.campaign.runs if r.name == "coast-down")
    namesake = replace(run, name="coast-down@2")
    campaign = replace(case.campaign, runs=(*case.campaign.runs, namesake))
    used = {**case.final["runs"], "coast-down@2": case.final["runs"]["coast-down"]}
    both = replace(case, campaign=campaign, told={**case.told, "final": {**case.final, "runs": used}})
    assert len(both.pieces(run)) == len(both.pieces(namesake)) == 1
