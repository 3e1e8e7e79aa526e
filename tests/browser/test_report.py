"""The report in a real browser, from disk, with the network off."""

from __future__ import annotations

import csv
import json
import re
import shutil
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from tests.browser.conftest import CHROMIUM, DIAGNOSIS, LOOKS, SAMPLE, Reader, handed_out, launched, report_of
from tests.flips import flipping
from tests.kit import tracked, with_settings
from wheelchair_fmu.campaign import Campaign, moving, read, windows
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.inference.decision.among_forces import FORCES as UNRECORDED
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.report.content import TUNING, noise_told
from wheelchair_fmu.report.page import page as page_of
from wheelchair_fmu.report.page import unpacked
from wheelchair_fmu.report.tale import Story

HIDDEN = "rolling_resistance_asymmetry"
TOLD = json.loads(DIAGNOSIS.read_text())
MODELS = {m["step"]: m["values"] for m in TOLD["models"]}


@pytest.fixture(scope="module")
def campaign() -> Campaign:
    return windows(read(SAMPLE))


def variant_of(reader: Reader, model: int) -> Variant:
    return Variant().with_effects(reader.page.evaluate("i => report.campaign.models[i].effects", model))


def test_ticking_the_hidden_effect_brings_the_held_out_bar_to_the_floor(reader):
    page = reader.page
    assert "rolls harder" in page.inner_text("h1")
    before = page.evaluate("report.now")
    assert before["heldout"] == pytest.approx(TOLD["ladder"][1]["heldout"], abs=0.01)
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    after = page.evaluate("report.now")
    assert after["heldout"] == pytest.approx(1.0, abs=0.03)
    assert f"{TOLD['ladder'][-1]['heldout']:.2f}" in page.text_content("#staircase svg")
    assert page.inner_text("#now-heldout") == f"{after['heldout']:.2f}"
    page.uncheck(f"#effect-{HIDDEN}")
    reader.settle()
    assert page.evaluate("report.now.heldout") == pytest.approx(before["heldout"], rel=1e-9)


@pytest.mark.parametrize(
    ("step", "model", "more"),
    [
        ("nominal", 0, {}),
        (f"+{HIDDEN}", 0, {}),
        ("calibrated", 0, {"effect.push_force_delay.tau": 0.013, "offset.yaw_rate": 0.02}),
        ("calibrated", 1, {"effect.relaxation_length.sigma": 0.08, "effect.trunk_motion.amplitude": 0.01}),
        # casters that swing start as they stand
        pytest.param("calibrated", 2, {"effect.caster_inertia.I": 0.01}, marks=pytest.mark.nightly),
    ],
)
def test_whitened_errors_are_pythons(open_report, campaign, step, model, more):
    """The same start, weights and errors as `Likelihood`, which `wheelchair compare` whitens with."""
    values = {**MODELS[step], **more}
    open_report.set(values)
    expected = Likelihood(campaign, variant_of(open_report, model)).evidence(campaign.runs, values, tune_start=2).table()
    found = open_report.table()
    for run, row in expected.items():
        for channel, rms in row.items():
            assert found[run][channel] == pytest.approx(rms, rel=1e-7), (run, channel)


def test_the_band_is_of_noise_and_of_what_fitted_values_are_uncertain_by(reader, campaign):
    """1.96 standard deviations either side, as `Likelihood` has them: of readings, and of the last model's values; where values
    were set by hand, of readings alone. On held-out runs it holds what 95 % are."""
    values, page = MODELS[f"+{HIDDEN}"], reader.page
    reader.set(values)
    expected = Likelihood(campaign, variant_of(reader, 0)).evidence(campaign.holdout, values, tune_start=2)
    inside = []
    for e in expected.runs:
        for i, channel in enumerate(e.channels):
            page.evaluate("([run, channel]) => report.show(run, channel)", [campaign.runs.index(e.run), channel])
            page.wait_for_function("() => report.doubt()")
            found = np.array(page.evaluate("report.band(report.results[report.shown.run]).map(edge => [...edge])"))
            half = 1.96 / e.whitener.spread[:, i]
            assert np.all(found[1] - found[0] >= 2 * half * (1 - 1e-6))
            alone = np.array(page.evaluate("report.band(report.results[report.shown.run], null).map(edge => [...edge])"))
            assert alone == pytest.approx(np.array([e.predicted[:, i] - half, e.predicted[:, i] + half]), rel=1e-6, abs=1e-6)
            inside.append((e.measured[:, i] >= found[0]) & (e.measured[:, i] <= found[1]))
    assert all(0.90 <= np.mean(one) <= 0.98 for one in inside)
    page.evaluate("report.put({...report.values, 'chair.m': 81})")
    assert page.evaluate("report.doubt()") is None


def test_what_a_run_sets_is_so_in_the_page(browser, tmp_path):
    """Starts and parameters of single runs, of which position was tracked too, with coloured noise of sensors and pushes:
    the same starts and errors as `Likelihood`."""
    folder, colours = tracked(with_settings(SAMPLE, tmp_path / "campaign")), {"F_rl": 0.7, "a_y": 0.5}
    told = {**TOLD, "noise": {**TOLD["noise"], "ar": colours}}
    (tmp_path / "told.json").write_text(json.dumps(told))
    reader, measured = (
        Reader(browser, report_of(folder, tmp_path / "report.html", tmp_path / "told.json")),
        windows(read(folder)),
    )
    colour = NoiseModel(measured.noise, colours)
    for step in MODELS:
        reader.set(MODELS[step])
        expected = Likelihood(measured, variant_of(reader, 0), colour).evidence(measured.runs, MODELS[step], tune_start=2)
        found = reader.table()
        for i, e in enumerate(expected.runs):
            assert found[e.run.name] == pytest.approx(e.rms, rel=1e-7), e.run.name
            assert reader.page.evaluate("i => report.results[i].start", i) == pytest.approx(e.start, abs=1e-7)
            assert {n: e.start[n] for n in e.run.set if n in e.start} == {n: v for n, v in e.run.set.items() if n in e.start}
    reader.close()


def test_a_filmed_body_pushes_beside_its_record_as_in_the_search(browser, tmp_path):
    """In the runs that filmed it, by the camera's noise."""
    folder = Path(shutil.copytree(SAMPLE, tmp_path / "campaign"))
    file, toml = folder / "runs" / "straight-strokes.csv", folder / "campaign.toml"
    run = pd.read_csv(file)
    run["rider.s [m]"] = 0.06 * np.sin(2 * np.pi * run["time [s]"]) + np.random.default_rng(3).normal(0, 2e-3, len(run))
    run.to_csv(file, index=False)
    toml.write_text(toml.read_text().replace("[tyre]", "[rider]\nm = 45.0\n\n[tyre]"))
    reader, measured = Reader(browser, report_of(folder, tmp_path / "report.html")), windows(read(folder))
    noise = noise_told(TOLD, measured.noise)
    values = MODELS[f"+{HIDDEN}"]
    reader.set(values)
    found, by_noise = reader.table(), {}
    for known in (noise, replace(noise, sd={**noise.sd, "rider.momentum": 0.0})):
        expected = Likelihood(measured, variant_of(reader, 0), known).evidence(measured.runs, values, tune_start=2)
        by_noise[known.wrong] = {e.run.name: e.rms for e in expected.runs}
    with_it, without = (by_noise[wrong] for wrong in (noise.wrong, 0.0))
    for name, errors in with_it.items():
        assert found[name] == pytest.approx(errors, rel=1e-7), name
    filmed = "straight-strokes"
    assert noise.wrong > 0.1 and without[filmed]["a_x"] > 1.1 * with_it[filmed]["a_x"]
    assert without["coast-down"] == pytest.approx(with_it["coast-down"], rel=1e-9)
    reader.close()


def test_forces_that_nobody_recorded_are_among_the_noise_as_in_the_search(browser, tmp_path, campaign):
    """Every run is led along them, from where it was led to at the values before, and weighed by them."""
    ladder = [*TOLD["ladder"][:2], {**TOLD["ladder"][1], "step": UNRECORDED}, *TOLD["ladder"][2:]]
    forces = {
        "force": 3.0,
        "moment": 0.4,
        "body": 1.5,
        "floor": 2.0,
        "lever": 0.12,
        "stroke": 30.0,
        "lasting": 0.7,
        "mass": 82.0,
        "by_run": {"slalom-quick": {"a_y": 1.3}},
    }
    told = {**TOLD, "ladder": ladder, "noise": {**TOLD["noise"], **forces}}
    (tmp_path / "told.json").write_text(json.dumps(told))
    reader = Reader(browser, report_of(SAMPLE, tmp_path / "report.html", tmp_path / "told.json"))
    values, rolls, before = MODELS[f"+{HIDDEN}"], moving(campaign), reader.page.evaluate("report.values")
    reader.set(values)
    likelihood = Likelihood(rolls, variant_of(reader, 0), noise_told(told), leads=True)
    shown = likelihood.evidence(rolls.runs, before, tune_start=TUNING)
    expected = likelihood.continued(shown).evidence(rolls.runs, values, tune_start=TUNING)
    table = reader.table()
    for i, e in enumerate(expected.runs):
        assert table[e.run.name] == pytest.approx(e.rms, rel=1e-7), e.run.name
        found = reader.page.evaluate("i => [report.results[i].start, report.results[i].sd.a_y[50]]", i)
        assert found[0] == pytest.approx(e.started, abs=1e-7)
        assert found[1] == pytest.approx(
            1 / e.whitener.spread[50, e.channels.index("a_y")], rel=1e-8
        )  # each browser has an exp of its own
    quickly = "values => report.pool.later({run: 9, values, exact: false}).then(r => [...r.predicted.yaw_rate])"
    again = reader.page.evaluate(quickly, values)
    assert again == pytest.approx(expected.runs[9].predicted[:, expected.runs[9].channels.index("yaw_rate")], abs=1e-5)
    reader.close()


@pytest.mark.nightly
def test_where_casters_flip_a_run_goes_where_errors_of_its_pushes_lead(browser, tmp_path):
    """As in `Likelihood`, also where values are moved a little from there."""
    inertia = {"effect.caster_inertia.I": 0.01}
    measured = windows(flipping(tmp_path / "campaign", Variant().with_effects(["caster_inertia"]), inertia))
    told = {**TOLD, "campaign": measured.name, "noise": {**TOLD["noise"], "sd": dict(measured.noise), "ar": {}}}
    (tmp_path / "told.json").write_text(json.dumps(told))
    reader = Reader(browser, report_of(tmp_path / "campaign", tmp_path / "report.html", tmp_path / "told.json"))
    reader.set(inertia)
    likelihood = Likelihood(measured, variant_of(reader, 2), NoiseModel(measured.noise))
    expected = likelihood.evidence(measured.runs, inertia, tune_start=2)
    found = reader.table()
    for e in expected.runs:
        assert found[e.run.name] == pytest.approx(e.rms, rel=1e-5), e.run.name
    assert any(e.pushed is not None for e in expected.runs)
    near = {"effect.caster_inertia.I": 0.0101}
    quickly = "([run, values]) => report.pool.later({run, values, exact: false}).then(r => r.squares)"
    for i, e in enumerate(likelihood.resimulated(expected, near).runs):
        squares = reader.page.evaluate(quickly, [i, near])
        assert squares["yaw_rate"] == pytest.approx(np.nansum(e.e[:, e.channels.index("yaw_rate")] ** 2), rel=0.2), e.run.name
    reader.close()


@pytest.mark.parametrize("model", [0, 1, 2])
@pytest.mark.parametrize(("tolerance", "grid", "bound"), [(1e9, 0.01, 1e-9), (1e-6, 0.0, 1e-6)])
def test_the_simulation_is_pythons(open_report, campaign, model, tolerance, grid, bound):
    """On one list of steps (no error test: a step for each sample), and on the steps that each finds for itself."""
    simulator = Simulator(variant_of(open_report, model))
    brought = [{}, {"effect.relaxation_length.sigma": 0.1}, {"effect.caster_inertia.I": 0.005}][model]
    values = {"tyre.C_lambda": 4500.0, "effect.scrub_torque.M": 0.3, "start.u": 0.8, **brought}
    run = campaign.runs[-1]
    page = open_report.page.evaluate(
        """async ({values, tolerance, grid}) => {
        const {time, inputs} = report.campaign.runs.at(-1);
        const {outputs, y} = await report.pool.trace({values, time, inputs, tolerance, grid});
        return {outputs, y: [...y]};
    }""",
        {"values": values, "tolerance": tolerance, "grid": grid},
    )
    p = simulator.variant.vector({**campaign.known, **values})
    there = simulator.run(run.time, simulator.inputs(len(run.time), run.inputs), p, tolerance=tolerance, grid=grid)
    assert tuple(page["outputs"]) == there.names
    y = np.reshape(page["y"], there.results.shape)
    assert np.max(np.abs(y - there.results) / (1 + np.abs(there.results))) < bound


def test_dragging_follows_at_once(reader):
    """The run that is shown first, then all ten, while the pointer still moves; frames go on.

    Times are printed with -s and not asserted: other programs run beside the tests.
    """
    page = reader.page
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    slider = page.locator(f'[id="slider-effect.{HIDDEN}.D"]')
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + box["height"] / 2)
    page.mouse.down()
    begun, errors = page.evaluate("report.timings.length"), []
    page.evaluate("""() => {
        window.frames_at = [];
        const frame = (now) => { frames_at.push(now); requestAnimationFrame(frame); };
        requestAnimationFrame(frame);
        report.costs.length = 0;
    }""")
    for i in range(25):
        page.mouse.move(box["x"] + (0.7 - 0.02 * i) * box["width"], box["y"] + box["height"] / 2)
        page.wait_for_timeout(60)
        errors.append(page.evaluate("report.now.heldout"))
    frames = page.evaluate("1000 * (frames_at.length - 1) / (frames_at.at(-1) - frames_at[0])")
    drawing = median(page.evaluate("report.costs.filter(c => !c.rested).map(c => c.ms)"))
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + box["height"] / 2)  # at zero the effect is out
    page.wait_for_timeout(300)
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + box["height"] / 2)
    page.wait_for_function(f"() => report.values['effect.{HIDDEN}.D'] < -0.5")  # and the drag goes on
    page.mouse.up()
    reader.settle()
    timings = [t for t in page.evaluate("report.timings")[begun:] if not t["exact"]]
    one, every = median(t["one"] for t in timings), median(t["all"] for t in timings)
    paint = page.evaluate("performance.getEntriesByName('first-contentful-paint')[0].startTime")
    exact = page.evaluate("report.timings.filter(t => t.exact).at(-1).all")
    print(
        f"\nfirst paint {paint:.0f} ms; one run {one:.0f} ms, ten runs {every:.0f} ms (median of {len(timings)}); "
        f"exact, ten runs {exact:.0f} ms; {frames:.0f} frames a second while dragging, {drawing:.1f} ms of main thread to draw"
    )
    assert errors[-1] > errors[0] + 0.1  # away from the truth, the error grows
    assert timings
    assert one < every


def test_the_keyboard_reaches_everything(reader):
    page = reader.page
    page.focus(f"#effect-{HIDDEN}")
    page.keyboard.press("Space")
    reader.settle()
    slider = page.locator(f'[id="slider-effect.{HIDDEN}.D"]')
    slider.focus()
    before = page.evaluate("report.values")[f"effect.{HIDDEN}.D"]
    page.keyboard.press("ArrowRight")
    reader.settle()
    assert page.evaluate("report.values")[f"effect.{HIDDEN}.D"] > before
    page.focus("#where button[tabindex='0']")  # of all cells one; arrow keys go on from there
    assert page.locator("#where td button[tabindex='0']").count() == 1
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowUp")
    cell = page.evaluate("document.activeElement.getAttribute('aria-label')")
    page.keyboard.press("Enter")
    assert page.evaluate("report.campaign.runs[report.shown.run].name") == cell.split(",")[0]
    page.focus("#run")
    page.keyboard.press("ArrowUp")
    assert page.evaluate("report.shown.run") == int(page.input_value("#run"))
    unnamed = page.evaluate("""[...document.querySelectorAll('button, input, select, a')].filter(e =>
        !(e.innerText?.trim() || e.getAttribute('aria-label') || e.labels?.length)).map(e => e.outerHTML)""")
    assert not unnamed


def test_a_value_out_of_bounds_is_not_taken(reader):
    page = reader.page
    page.evaluate("for (const d of document.querySelectorAll('#controls details')) d.open = true")
    number = page.locator('[data-name="tyre.C_lambda"]')
    before = page.evaluate("report.values")
    number.fill("")
    number.press_sequentially("-3")
    number.blur()
    assert page.evaluate("report.values") == before
    assert not number.evaluate("e => e.checkValidity()")


STARTS = {"PNG": b"\x89PNG", "SVG": b"<?xml", "PDF": b"%PDF-1.3"}
EMBEDDED = rb"/FontFile2 \d+ 0 R"


def taken(reader: Reader, figure: str, label: str, folder: Path) -> Path:
    """The file that a figure's menu hands out."""
    reader.page.click(f"#{figure} .menu > summary")
    button = reader.page.locator(f"#{figure} .menu button", has_text=label)
    name, content = handed_out(reader.page, button.click)
    reader.page.keyboard.press("Escape")
    (folder / name).write_bytes(content)
    return folder / name


def words_of(reader: Reader, file: Path) -> list[str]:
    """What is wrong with the words of a figure's file: cut off, over one another, or less than six points high."""
    page = reader.context.new_page()
    page.goto(file.as_uri())
    wrong = page.evaluate(Path(__file__).with_name("sheet.js").read_text())
    page.close()
    return list(wrong)


def table_of(reader: Reader, figure: str, folder: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(taken(reader, figure, "CSV", folder).read_text(encoding="utf-8").splitlines()))


def test_tables_hold_the_numbers_of_the_diagnosis(open_report, tmp_path):
    open_report.set(MODELS["calibrated"])
    stairs = table_of(open_report, "staircase", tmp_path)
    assert [(float(r["fitted runs"]), float(r["held-out runs"])) for r in stairs] == [
        (s["fit"], s["heldout"]) for s in TOLD["ladder"]
    ]
    sizes = {f"effect.{r['effect']}.{n}": p for r in TOLD["ranking"] for n, p in r["parameters"].items()}
    for row in table_of(open_report, "forest", tmp_path):
        told = sizes[row["name in files"]]
        unit = {"rad": "deg", "rad/s": "deg/s"}.get(told["unit"], told["unit"])  # as in the figure
        factor = 1 if unit == told["unit"] else 180 / np.pi
        assert row["unit"] == unit and float(row["estimate"]) == pytest.approx(factor * told["estimate"])
        se = np.nan if told["se"] is None else factor * told["se"]
        assert float(row["standard error"] or "nan") == pytest.approx(se, nan_ok=True)
        assert float(row["matters from"]) == pytest.approx(factor * told["smallest_interesting"])
        assert float(row["in sizes that matter"]) == pytest.approx(told["estimate"] / told["smallest_interesting"])
    open_report.page.click("#forest details.numbers summary")
    open_report.page.wait_for_selector("#forest details.numbers th")
    heads = open_report.page.locator("#forest details.numbers th").all_inner_texts()
    assert "±" in heads and not {"name in files", "standard error"} & set(heads), "the page's own table is in plain words"
    for row in table_of(open_report, "calibration", tmp_path):
        told = TOLD["calibration"][row["name in files"]]
        heads = ("fitted", "standard error", "given", "given to within (standard deviation)")
        assert [float(row[k]) for k in heads] == [told[k] for k in ("value", "se", "prior", "prior_sd")]
    cells = open_report.table()
    for row in table_of(open_report, "where", tmp_path):
        assert float(row["error, noise = 1"]) == pytest.approx(cells[row["run"]][row["channel"]])
    rows = table_of(open_report, "physical", tmp_path)
    told = [s["channels"][c] for c in TOLD["physical"] for s in TOLD["ladder"]]
    assert [(float(r["error"]), float(r["noise = 1"])) for r in rows] == [(t["heldout_rms"], t["heldout"]) for t in told]


@pytest.mark.parametrize(
    "figure",
    [
        "staircase",
        "overlay",
        "joint",
        *(
            pytest.param(f, marks=pytest.mark.nightly)
            for f in ("where", "path", "regimes", "forest", "physical", "profiles", "calibration")
        ),
    ],
)
def test_every_figure_can_be_published(open_report, figure, tmp_path):
    """On white, as wide as it says, with its campaign, and a table that is whole."""
    for kind, start in STARTS.items():
        for mm in (85, 170):
            file = taken(open_report, figure, f"{kind} {mm} mm", tmp_path)
            content = file.read_bytes()
            assert file.suffix == f".{kind.lower()}" and content.startswith(start), file
            if kind == "SVG":
                drawn = ElementTree.fromstring(content)
                assert drawn.get("width") == f"{mm}mm"
                assert TOLD["campaign"] in "".join(drawn.itertext())
                assert "NaN" not in content.decode() and "undefined" not in content.decode()
                fonts = re.findall(r"font-weight:(\w+);src:url\(data:font/ttf;base64,", content.decode())
                assert fonts == ["normal", "bold"]
                assert words_of(open_report, file) == []
            if kind == "PNG":
                with Image.open(file) as picture:
                    assert picture.width == round(mm / 25.4 * 400)
                    assert picture.info["dpi"] == pytest.approx((400, 400), abs=0.01)  # what sets text takes its width from it
                    assert picture.convert("RGB").getpixel((2, 2)) == (255, 255, 255)
            if kind == "PDF":
                width = float(re.search(rb"MediaBox \[0 0 ([\d.]+)", content)[1])  # type: ignore[index]
                assert width == pytest.approx(mm / 25.4 * 72, abs=0.02)
                assert content.rstrip().endswith(b"%%EOF")
                assert len(set(re.findall(EMBEDDED, content))) == 2  # regular and bold
                assert b"/Subtype /Image" not in content and b"/Type1" not in content
    rows = list(csv.reader(taken(open_report, figure, "CSV", tmp_path).read_text(encoding="utf-8").splitlines()))
    assert len(rows) > 3
    assert len({len(r) for r in rows}) == 1


def test_names_of_runs_are_whole_in_one_column_of_a_journal(open_report, tmp_path):
    """Heads stand upright where beside one another they would leave a name no room."""
    drawn = ElementTree.fromstring(taken(open_report, "where", "SVG 85 mm", tmp_path).read_bytes())
    words = ["".join(e.itertext()) for e in drawn.iter("{http://www.w3.org/2000/svg}text")]
    assert {"coast-down", "straight-strokes", "yaw rate"} <= set(words)


@pytest.mark.parametrize("name", ["輪椅", "مقعد"])  # not in the fonts; in them, but joined from right to left
def test_a_name_that_the_fonts_cannot_write_becomes_a_picture(browser, report_file, tmp_path, name):
    content = unpacked(report_file.read_text(encoding="utf-8"))
    content["name"] = name
    story = Story([{"head": "What", "lead": name, "lines": []}] * 3, content["story"]["screens"])
    (tmp_path / "odd.html").write_text(page_of(content, name, [], story), encoding="utf-8")
    reader = Reader(browser, tmp_path / "odd.html")
    written = taken(reader, "staircase", "PDF 85 mm", tmp_path).read_bytes()
    assert b"/Subtype /Image" in written and not re.search(EMBEDDED, written)
    reader.close()


@pytest.mark.parametrize(("scheme", "width"), LOOKS)
def test_it_fits(browser: Any, report_file: Path, width, scheme):
    """Nothing sticks out sideways, and text stands out from what is behind it."""
    reader = Reader(browser, report_file, width, scheme)
    assert reader.page.evaluate("document.documentElement.scrollWidth") <= width
    contrast = reader.page.evaluate(Path(__file__).with_name("contrast.js").read_text())
    assert min(contrast.values()) >= 4.5, contrast
    reader.close()


def test_each_model_is_small_and_simulates_in_no_time(open_report):
    """What a run of 20 s at 100 Hz takes is printed with -s: the fastest of nine."""
    sizes = open_report.page.evaluate("report.campaign.models.map(m => atob(m.wasm).length)")
    brought = [{}, {"effect.relaxation_length.sigma": 0.1}, {"effect.caster_inertia.I": 0.005}]
    times = [
        open_report.page.evaluate(
            """async (values) => {
        const {inputs} = report.campaign.runs.at(-1), n = 2001, time = Float64Array.from({length: n}, (_, i) => i / 100);
        const longer = Object.fromEntries(Object.entries(inputs).map(([k, v]) => [k, time.map((_, i) => v[i % v.length])]));
        let least = Infinity;
        for (let i = 0; i < 9; i++) {
            const {ms} = await report.pool.trace({values, time, inputs: longer, tolerance: report.campaign.tolerance, grid: 0});
            least = Math.min(least, ms);
        }
        return least;
    }""",
            {"start.u": 0.8, **values},
        )
        for values in brought
    ]
    print("\nWebAssembly: " + ", ".join(f"{b} bytes and {ms:.1f} ms" for b, ms in zip(sizes, times, strict=True)))
    assert max(sizes) <= 100_000
    assert open_report.page.evaluate("atob(report.campaign.evaluation).length") <= 60_000  # once for all of them


def test_one_file_small_and_shut(report_file):
    text = report_file.read_text(encoding="utf-8")
    assert report_file.stat().st_size <= 1.8e6
    assert "default-src 'none'" in text
    assert 'src="http' not in text


@CHROMIUM
@pytest.mark.nightly
def test_firefox_has_the_figures_of_chromium(driver, browser, report_file):
    values = {**MODELS[f"+{HIDDEN}"], "tyre.C_lambda": 4500.0, "effect.push_force_delay.tau": 0.013}
    other, told = launched(driver, "firefox"), []
    for one in (browser, other):
        reader = Reader(one, report_file)
        reader.set(values)
        edges = reader.page.evaluate("report.band(report.results[report.shown.run], null).map(e => [...e])")
        told.append((reader.page.evaluate("report.shown"), reader.table(), edges))
        reader.close()
    other.close()
    (shown, table, edges), (there, other_table, other_edges) = told
    assert shown == there
    for run in table:
        assert table[run] == pytest.approx(other_table[run], rel=1e-9), run
    np.testing.assert_allclose(edges, other_edges, rtol=1e-9, atol=1e-9)
