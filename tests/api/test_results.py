"""What a diagnosis, a comparison and a tyre give to other programs, and what is refused."""

from __future__ import annotations

import json
import math
import re
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

import wheelchair_fmu as wc
from tests.kit import SAMPLE_DIAGNOSIS
from wheelchair_fmu.api import runs
from wheelchair_fmu.api.diagnoses import probabilities_in
from wheelchair_fmu.cli.effects import template
from wheelchair_fmu.inference.subject import narrowed
from wheelchair_fmu.model import variant as chairs
from wheelchair_fmu.report import latex
from wheelchair_fmu.report.estimates_figure import estimates_figure
from wheelchair_fmu.studies import archives

HIDDEN = ("rolling_resistance_asymmetry", "D")


def test_a_diagnosis_says_the_same_in_every_form(found, tmp_path):
    told = json.loads(found.save(tmp_path / "d.json").read_text(encoding="utf-8"))
    assert told == json.loads(json.dumps(found.as_dict())) and told["verdict"] == found.verdict
    row = found.estimates.loc[HIDDEN]
    assert row.lower < row.estimate < row.upper and row.unit == "N" and row.verdict == "missing"
    assert [row.lower, row.upper] == told["ranking"][0]["parameters"]["D"]["interval"]
    table = pd.read_csv(found.save(tmp_path / "e.csv"), index_col=[0, 1])
    assert table.loc[HIDDEN, "estimate"] == pytest.approx(row.estimate, rel=1e-9) and len(table) == len(found.estimates)
    text = found.save(tmp_path / "e.tex").read_text(encoding="utf-8")
    assert rf"\texttt{{rolling\_resistance\_asymmetry.D}} & ${row.estimate:.3f} \pm {row.se:.3f}$" in text
    assert text.count(r"\\") == 2 + len(found.calibration) and text.count("{") == text.count("}")
    assert set(found.calibration.columns) >= {"value", "se", "prior", "prior_sd", "unit", "at_bound", "beyond"}
    with pytest.raises(wc.UsageError, match=r"no form of a diagnosis that ends in '\.xls'"):
        found.save(tmp_path / "e.xls")


def test_a_figure_shows_itself_in_a_notebook(found):
    assert found.plot_staircase()._repr_png_().startswith(b"\x89PNG")


def test_the_diagnosis_that_other_tests_read_is_of_todays_form(found):
    """Where it is not, it is to be made again by the command that stands in tests/kit.py."""
    told, kept = found.as_dict(), json.loads(SAMPLE_DIAGNOSIS.read_text(encoding="utf-8"))
    assert form(kept) == form(json.loads(json.dumps(told)))
    assert {r["effect"] for r in kept["ranking"]} == {r["effect"] for r in told["ranking"]}
    assert [s["step"] for s in kept["models"]] == [s["step"] for s in told["models"]]


def test_the_page_on_what_a_diagnosis_holds_names_every_key():
    page = (Path(__file__).parents[2] / "docs" / "diagnosis.md").read_text(encoding="utf-8")
    assert [key for key in json.loads(SAMPLE_DIAGNOSIS.read_text(encoding="utf-8")) if f"`{key}`" not in page] == []


def form(told, place=""):
    """Every key that there is, at its place."""
    if isinstance(told, dict):
        inner = [(k if place not in MANY else "…", v) for k, v in told.items()]
        return {p for k, v in inner for p in ({f"{place}.{k}"} | form(v, f"{place}.{k}"))}
    return {p for v in told for p in form(v, place)} if isinstance(told, list) else set()


MANY = (".ranking.parameters", ".ranking.values", ".models.values", ".calibration", ".physical", ".physical.….runs")  # by name


def test_a_diagnosis_has_the_whole_final_fit(found):
    told = found.as_dict()
    final = told["final"]
    names = [p["name"] for p in final["parameters"]]
    covariance = np.array(final["covariance"])
    assert covariance.shape == (len(names), len(names)) and np.array_equal(covariance, covariance.T)
    se = dict(zip(names, np.sqrt(np.diag(covariance)), strict=True))
    assert [se[n] for n in found.calibration.index] == pytest.approx(found.calibration["se"].tolist(), rel=1e-12)
    assert se[f"effect.{HIDDEN[0]}.{HIDDEN[1]}"] == pytest.approx(found.estimates.loc[HIDDEN].se, rel=1e-12)
    assert {p["name"]: p["estimate"] for p in final["parameters"]} == told["models"][-1]["values"]
    assert {p["name"]: p["prior"] for p in final["parameters"] if p["prior"]} == found.calibration["prior"].to_dict()
    assert final["step"] == told["ladder"][-1]["step"] and not any(p["at_bound"] for p in final["parameters"])
    assert all(c["used"] == c["readings"] for c in final["runs"]["slalom-slow"]["channels"].values())
    assert told["fingerprint"] == found._campaign.fingerprint and told["made_by"]["version"] == wc.__version__


def test_a_notebook_shows_the_verdict_and_the_staircase(found):
    html = found._repr_html_()
    assert found.sentence in html and "<svg" in html and "held-out" in html


def test_probabilities_are_those_of_the_ranking_the_likeliest_first():
    ranking = [
        {"effect": "a", "probability": 0.1},
        {"effect": "b", "probability": 0.9},
        {"effect": "c"},
        {"effect": "d", "probability": None},
    ]
    assert list(probabilities_in(ranking).items()) == [("b", 0.9), ("a", 0.1)]


def test_estimates_are_drawn_in_sizes_of_interest(found):
    rows = [{"name": "a", "estimate": 2.0, "lower": 1.0, "upper": 3.0, "smallest_interesting": 0.5, "found": True}]
    (points,) = (line for line in estimates_figure(rows).axes[0].lines if line.get_label() == "found")
    assert points.get_xdata() == [4.0]
    assert not estimates_figure([]).axes[0].get_yticklabels(), "where nothing was looked for"
    assert len(found.plot_estimates().axes[0].get_yticklabels()) == 10
    with pytest.raises(wc.Failure, match="the verdict is missing, and no term is proposed"):
        found.plot_missing()


@pytest.mark.parametrize(
    ("row", "line"),
    [
        (
            ("a.b_c", 1.2345, 0.0123, 1.2, 1.3, "N.m/rad"),
            r"\texttt{a.b\_c} & $1.234 \pm 0.012$ & $[1.2, 1.3]$ & $\mathrm{N\,m/rad}$ \\",
        ),
        (("x", 2.5e-7, math.nan, math.nan, math.nan, "1"), r"\texttt{x} & $2.5 \times 10^{-7}$ & -- & -- \\"),
        (("y", -3.0, 0.5, -4.0, -2.0, "m/s2"), r"\texttt{y} & $-3.0 \pm 0.5$ & $[-4, -2]$ & $\mathrm{m/s^{2}}$ \\"),
    ],
)
def test_latex(row, line):
    assert line in latex.table([row]).splitlines()


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_what_was_simulated_is_a_recording_with_its_units(ending, tmp_path):
    """A run through the FMU, written, is read by a campaign that says no unit."""
    spin = wc.simulate("spin", time=4.0)
    shown = spin[["push.F_rl", "push.F_rr", "sensor.yaw_rate", "sensor.wheel_speed_l"]]
    shown = shown.rename(columns=lambda name: name.rpartition(".")[2])
    shown.attrs["units"] = {name.rpartition(".")[2]: unit for name, unit in spin.attrs["units"].items()}
    file = wc.save(shown, tmp_path / f"spin.{ending}")
    (tmp_path / "campaign.toml").write_text(
        f'[campaign]\naxes = "SAE-J670"\n[noise]\nF_rl = 0.1\nF_rr = 0.1\nyaw_rate = 0.01\nwheel_speed_l = 0.01\n'
        f'[[run]]\nfile = "{file.name}"\nmanoeuvre = "spin"\nrole = "fit"\n',
        encoding="utf-8",
    )
    again = wc.read(tmp_path).frame("spin")
    assert again.attrs["units"]["yaw_rate"] == "rad/s"
    assert np.allclose(again["yaw_rate"], spin["sensor.yaw_rate"], atol=1e-9)


def test_parquet_has_units_in_its_fields(tmp_path):
    file = wc.save(wc.simulate("coast-down", time=0.1), tmp_path / "c.parquet")
    schema = pq.read_schema(file)
    assert schema.field("chair.u").metadata[b"unit"] == b"m/s" and schema.field("time").metadata[b"unit"] == b"s"
    assert pd.read_parquet(file)["chair.u"].iloc[0] == 1.0


def test_a_comparison_has_what_was_measured_and_simulated(campaign):
    compared = campaign.compare(
        values={"effect.rolling_resistance_asymmetry.D": 1.6}, calibrate=["tyre.C_lambda", "resistance.f_r"]
    )
    frame, sd = compared.frame("steady-left"), campaign.noise.loc["yaw_rate", "sd"] / np.sqrt(2)  # of two readings
    left = (frame["yaw_rate"] - frame["yaw_rate.simulated"]) / sd
    assert np.sqrt(np.mean(left**2)) >= compared.rms.loc["steady-left", "yaw_rate"] > 0.9  # pushes have noise, too
    assert compared.holdout < 1.3 and compared.values["tyre.C_lambda"] != 5038
    assert frame["a_x.simulated"].attrs is not None and frame.attrs["units"]["a_x.simulated"] == "m/s2"
    with pytest.raises(wc.UsageError, match="no run 'stedy-left'; did you mean"):
        compared.frame("stedy-left")


def test_variants_go_from_hand_to_hand(tmp_path):
    chair = wc.Variant({"chair.m": 110, "tyre.law": "dugoff"}, effects=["scrub_torque"])
    again = wc.Variant.read(chair.save(tmp_path / "v.toml"))
    assert (again.values, again.effects, again.laws) == (chair.values, chair.effects, chair.laws)
    by_object, by_file = (wc.simulate("slalom", time=1.0, variant=v) for v in (chair, tmp_path / "v.toml"))
    assert by_object.equals(by_file) and "scrub_torque" in chair._repr_html_()
    heavier = chair.with_values({"chair.m": 150})
    assert heavier.values["chair.m"] == 150 and chair.values["chair.m"] == 110
    loads = [wc.simulate("coast-down", time=0.1, variant=v)["load.rl"].iloc[-1] for v in (chair, heavier)]
    assert loads[1] / loads[0] == pytest.approx(150 / 110)


def test_what_the_fmu_warns_of_is_a_warning():
    with pytest.warns(RuntimeWarning, match="wheel|slip|range"):
        wc.simulate("spin", delta_force=400, time=2.0)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: wc.simulate("slolom"), "no manoeuvre 'slolom'; did you mean 'slalom'?"),
        (lambda: wc.simulate("slalom", values={"chair.mm": 1}), "no parameter 'chair.mm'"),
        (lambda: wc.simulate(pd.DataFrame({"push.F_rl": [0, 1]}), speed=1.0), "speed is of a manoeuvre"),
        (lambda: wc.simulate("slalom", fmu="a.fmu", effects="all"), "a finished FMU has its variant"),
        (lambda: wc.linearize(values={"speed.u": 2}), "here --speed decides that"),
        (lambda: wc.Variant(effects=["relaxation"]), "no effect 'relaxation'"),
        (lambda: wc.build(fmi="4"), "no version of FMI '4'"),
        (lambda: wc.Tyre.fit("rig.csv", tolerance=2), "tolerance 2 is no fraction"),
        (lambda: wc.sample("x", "campain"), "no sample 'campain'; did you mean 'campaign'?"),
    ],
)
def test_a_wrong_question_gets_a_sentence(ask, words):
    with pytest.raises(wc.UsageError, match=re.escape(words)):
        ask()


def test_a_campaign_with_faults_says_them_all(tmp_path):
    with pytest.raises(wc.CampaignError) as met:
        wc.read(tmp_path)
    assert met.value.faults and str(tmp_path) in str(met.value)


def test_a_variant_carries_the_effects_of_ones_own(tmp_path, monkeypatch):
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    (tmp_path / "effects").mkdir()
    (tmp_path / "effects" / "mine.py").write_text(template("force", "mine"), encoding="utf-8")
    chair = wc.Variant({"effect.mine.q": 2.0}, own_effects=tmp_path / "effects")
    file = chair.save(tmp_path / "mine.toml")
    shutil.rmtree(tmp_path / "effects")
    assert wc.Variant.read(file).values == chair.values
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "another machine's"))
    with pytest.raises(wc.WheelchairError, match="a program that runs with your rights"):
        wc.simulate("coast-down", time=0.1, variant=file)
    assert wc.Variant.read(file, trust=True).effects == ("mine",)


def test_what_is_not_asked_about_is_no_candidate(tmp_path):
    chair = chairs.Variant().with_effects(["scrub_torque"])
    assert set(narrowed(chair, ["gyro_bias"]).catalogue) == {"gyro_bias", "scrub_torque"}
    with pytest.raises(wc.UsageError, match="no effect 'gyro_bais'; did you mean 'gyro_bias'"):
        wc.diagnose(wc.sample(tmp_path / "sample")[0], among=["gyro_bais"])


def test_one_fmu_serves_all_tyre_laws(monkeypatch):
    built = []
    monkeypatch.setattr(runs, "fmu_of", lambda *asked: built.append(archives.fmu_of(*asked)) or built[-1])
    turns = [wc.simulate("steady-turn", delta_force=40.0, values={"tyre.law": law}) for law in ("linear", "magic_formula")]
    assert built[0] == built[1] and (turns[0]["slip.rr"] - turns[1]["slip.rr"]).abs().max() > 1e-4
