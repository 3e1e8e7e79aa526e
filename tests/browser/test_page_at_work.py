"""The story, one timeline, undoing, keeping, links, and everyone: the page in a browser, as a reader uses it."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from benchmarks.page_screens import FAULTS
from tests.browser.conftest import CHROMIUM, DIAGNOSIS, LOOKS, SAMPLE, Reader, pages_of, report_of
from wheelchair_fmu.report.page import page as page_of
from wheelchair_fmu.report.page import unpacked
from wheelchair_fmu.report.tale import Story

HIDDEN = "rolling_resistance_asymmetry"
TOLD = json.loads(DIAGNOSIS.read_text())
TOP = TOLD["ladder"][-1]


def test_five_screens_go_from_the_error_to_what_to_do(reader):
    page = reader.page
    shown = page.locator(".screen:visible")
    assert shown.count() == 1 and "errs" in shown.inner_text()
    assert page.locator(".screen:visible .stage svg").count() == 1
    page.click("text=next →")
    page.click(".choice >> text=one rear wheel that rolls harder")
    assert "Yes" in page.inner_text(".answer")
    page.wait_for_selector(".screen:visible .curve svg")  # and by its curve
    assert "with this guess" in page.text_content(".screen:visible .curve svg")
    letters = "[...document.querySelectorAll('.screen:not([hidden]) .curve text')]"
    inks = f"[...new Set({letters}.map((t) => t.getAttribute('fill')))]"
    light = page.evaluate(inks)
    page.click("#theme")  # and the curve follows the theme
    page.wait_for_function(f"(light) => !{inks}.some((ink) => light.includes(ink))", arg=light)
    page.click("#theme")
    page.click(".choice >> text=a slope across the chair")
    assert "Yes" not in page.inner_text(".answer")
    page.click(".tab >> nth=2")
    page.click(".screen:visible .big")
    reader.settle()
    page.wait_for_function("text => document.querySelector('.counter').innerText.includes(text)", arg=f"{TOP['heldout']:.2f}")
    page.click(".tab >> nth=3")
    assert page.locator(".screen:visible .stage svg").count() == 1
    page.click(".tab >> nth=4")
    assert "wheelchair add" in page.inner_text(".screen:visible code")


def test_the_error_is_drawn_against_what_was_going_on(reader):
    """Panels for the shown channel; with the effect in, its mean keeps to zero."""
    page = reader.page
    page.evaluate("report.show(report.campaign.runs.findIndex(r => r.role === 'holdout'), 'yaw_rate')")
    most = "Math.max(...report.figures.against.flatMap(p => p.means).map(Math.abs))"
    page.wait_for_function("() => document.querySelector('#regimes .caption').textContent.includes('yaw rate')")
    before, panels = page.evaluate(most), page.evaluate("report.figures.against.map(p => p.label)")
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    page.wait_for_function(f"() => {most} < 1")
    assert before > 2 and len(panels) == len(page.evaluate("report.campaign.regimes"))
    assert "Speed [m/s]" in panels and page.locator("#regimes svg path").count() > 2 * len(panels)


def test_a_tick_climbs_the_staircase_and_further_sizes_are_fitted_together(reader):
    page = reader.page
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    assert page.evaluate("report.values") == TOLD["models"][-1]["values"]
    assert page.evaluate("report.now") == pytest.approx({k: TOP[k] for k in ("fit", "heldout")}, abs=0.01)
    page.evaluate("for (const d of document.querySelectorAll('#controls details')) d.open = true")
    for effect in ("accelerometer_bias", "trunk_motion", "toe_misalignment"):  # two that fit far off where they are alone
        page.check(f"#effect-{effect}")
        reader.settle()
        assert page.evaluate("report.now.fit") <= TOP["fit"] + 0.002  # a model that has more to fit with does not fit worse
        assert page.is_checked(f"#effect-{effect}")
    values = page.evaluate("report.values")
    assert values[f"effect.{HIDDEN}.D"] == pytest.approx(1.6, abs=0.2)
    assert abs(values["effect.accelerometer_bias.x"]) < 0.03  # not the size that ticking begins with


def test_a_fit_is_finished_also_where_exact_numbers_are_asked_meanwhile(reader):
    """What a fit asks of the workers is nobody else's to drop."""
    values = {**TOLD["models"][-1]["values"], f"effect.{HIDDEN}.D": 0.7}
    reader.page.evaluate(
        """values => {
        report.controls.put(values);
        report.fitTogether(report.values);
        report.ask(true);
    }""",
        values,
    )
    reader.settle()
    assert reader.page.evaluate("report.now.fit") <= TOP["fit"] + 0.002


def test_sizes_fitted_in_the_page_are_those_of_the_search(reader):
    """From far off, the page's fit comes to where Python's came."""
    page = reader.page
    reader.set({**TOLD["models"][-1]["values"], f"effect.{HIDDEN}.D": 0.7})
    page.click("text=fit these sizes together")
    reader.settle()
    row = next(r for r in TOLD["ranking"] if r["effect"] == HIDDEN)["parameters"]["D"]
    assert page.evaluate("report.values")[f"effect.{HIDDEN}.D"] == pytest.approx(row["estimate"], abs=2 * row["se"])


def test_a_decimal_comma_is_a_decimal_point(reader):
    page = reader.page
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    field = page.locator("#controls .slider input[type=text] >> visible=true").first
    name = field.get_attribute("data-name")
    field.fill("")  # key by key: what a script puts into a field is no change to every browser
    field.press_sequentially("1,5")
    field.press("Enter")
    reader.settle()
    factor = page.evaluate("(name) => report.controls.sliders.get(name).factor", name)
    assert page.evaluate("(name) => report.values[name]", name) == pytest.approx(1.5 / factor)
    field.fill("")
    field.press_sequentially("heavy")
    field.press("Tab")
    assert page.evaluate("(e) => e.validationMessage", field.element_handle()) == "give a number, as in 1.5"
    assert page.evaluate("(name) => report.values[name]", name) == pytest.approx(1.5 / factor)


def test_the_chair_from_above_is_saved_with_the_chair(reader):
    """Two frames, wheels and casters, and the words of their colours, at the cursor."""
    reader.page.evaluate("report.timeline.go(3)")
    drawn = reader.page.evaluate("""() => {
      const made = report.figures.all.path.says.draw(400, {...report.look, ink: "#111111", print: true});
      return [made.querySelectorAll("svg path[transform]").length, made.textContent, report.figures.all.path.says.caption()];
    }""")
    assert drawn[0] > 15 and "side force of a tyre" in drawn[1] and "the chair 3.00 s into the run" in drawn[2]


DRAWN = "report.figures.all.path.says.draw(400, {...report.look, ink: '#111111', print: true})"
WORDS = f"[...{DRAWN}.querySelectorAll('text')].map(t => t.textContent)"


def test_each_wheel_says_what_it_carries(reader):
    """Together they carry the chair; the words are those of the file, too."""
    reader.page.evaluate("report.timeline.go(3)")
    words = reader.page.evaluate(WORDS)
    loads = [float(w.removesuffix(" N")) for w in words if re.fullmatch(r"[\d.]+ N", w)]
    assert len(loads) == 4 and sum(loads) == pytest.approx(80 * 9.81, abs=2.5)
    assert "load on each wheel" in reader.page.inner_text("#path .legend")
    assert not {"lifted", "would spin"} & set(words) and reader.page.locator(".limits").is_hidden()


def test_a_wheel_that_is_lifted_or_pushed_beyond_friction_says_so(reader):
    """At the wheel at the moment shown, and of the whole run in a sentence, as sliders move."""
    page = reader.page
    page.evaluate("report.show(report.campaign.runs.findIndex(r => r.name === 'straight-strokes'), 'yaw_rate')")
    reader.set({"tyre.mu": 0.05, "chair.b": 0.02, "effect.longitudinal_load_transfer.h": 1.0})
    at = "report.campaign.runs[report.shown.run].time[report.results[report.shown.run].results['{}'].{}]"
    page.wait_for_selector(".limits:visible")
    for flag, words in (("load.lifted", "lifted"), ("push.beyond_friction", "would spin")):
        first = at.format(flag, "indexOf(1)")
        page.evaluate(f"report.timeline.go({first})")
        assert words in page.evaluate(WORDS)
        assert f"first at {page.evaluate(first):.2f} s" in page.inner_text(".limits")
        page.evaluate(f"report.timeline.go({at.format(flag, 'indexOf(0)')})")
        assert words not in page.evaluate(WORDS)
    page.click("#reset")
    reader.settle()
    page.wait_for_selector(".limits", state="hidden")


@pytest.mark.nightly
def test_the_motion_of_the_body_is_seen_where_it_was_recorded(browser, tmp_path):
    campaign = tmp_path / "campaign"
    shutil.copytree(SAMPLE, campaign)
    file, toml = campaign / "runs" / "straight-strokes.csv", campaign / "campaign.toml"
    run = pd.read_csv(file)
    run["rider.s [m]"] = 0.06 * np.sin(2 * np.pi * run["time [s]"])
    run.to_csv(file, index=False)
    toml.write_text(toml.read_text().replace("[tyre]", "[rider]\nm = 45.0\n\n[tyre]"))
    reader = Reader(browser, report_of(campaign, tmp_path / "swinging.html"))
    page, legend = reader.page, lambda: reader.page.inner_text("#path .legend")
    page.evaluate("report.show(report.campaign.runs.findIndex(r => r.name === 'coast-down'), 'yaw_rate')")
    reader.settle()
    page.wait_for_function("!document.querySelector('#path .legend').innerText.includes('momentum')")
    page.evaluate("report.show(report.campaign.runs.findIndex(r => r.name === 'straight-strokes'), 'yaw_rate')")
    reader.settle()
    page.wait_for_function("document.querySelector('#path .legend').innerText.includes('its momentum')")
    page.evaluate("report.timeline.go(3.25)")  # when it is furthest forward
    assert re.search(r"rider’s body .*0\.0[56]\d? m forward, −?\d+(\.\d)? N s", legend())
    shifted = page.evaluate(f"{DRAWN}.outerHTML")
    page.evaluate("report.motion.inputs['rider.s'].fill(0)")
    assert page.evaluate(f"{DRAWN}.outerHTML") != shifted  # shoulders and head go with it
    assert "0 m forward" in page.evaluate(f"{DRAWN}.textContent")
    reader.close()


def test_the_laws_of_the_model_that_runs_are_told(reader):
    page = reader.page
    assert "tyres linear (" in page.inner_text("#laws") and "casters ideal (" in page.inner_text("#laws")
    reader.set({**TOLD["models"][-1]["values"], "effect.caster_friction.M": 0.3})  # which needs casters that swing
    assert "casters swivelling (" in page.inner_text("#laws") and "rear wheels rolling (" in page.inner_text("#laws")


def test_undo_reset_and_a_link_that_survives_a_reload(reader):
    page = reader.page
    start = page.evaluate("report.values")
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    ticked = page.evaluate("report.values")
    page.click("#undo")
    reader.settle()
    assert page.evaluate("report.values") == start
    page.click("#redo")
    reader.settle()
    assert page.evaluate("report.values") == ticked
    page.click("text=keep this as A")
    page.select_option("#run", label="slalom-quick")
    page.wait_for_function("() => report.timeline.lines.some(([name]) => name === 'A')")  # kept in whatever run is looked at
    reader.settle()
    heads = "Object.keys(report.figures.all.overlay.says.columns()).filter(head => /^(A|before) \\[/.test(head))"
    page.wait_for_function(f"() => {heads}.length === 2")  # the CSV has what the picture shows
    assert "what the search found" in page.evaluate("report.figures.all.where.says.subject()")
    page.evaluate("report.timeline.zoom(2, 5), report.timeline.go(3)")
    page.select_option('[aria-label="speed of playing"]', "0.25")
    page.check("#loop")
    page.click("#steps button >> nth=1")
    page.click(".choice >> nth=1")
    answer = page.inner_text(".answer")
    page.evaluate("report.written()")
    page.reload()
    reader.settle()
    assert page.evaluate("report.values") == ticked
    assert page.evaluate("report.timeline.pace()") == {"speed": 0.25, "loop": True}
    assert page.inner_text(".answer") == answer and page.get_attribute(".choice >> nth=1", "aria-pressed") == "true"
    assert page.evaluate(
        "[report.campaign.runs[report.shown.run].name, report.timeline.from, report.timeline.to, report.timeline.at]"
    ) == ["slalom-quick", 2, 5, 3]
    page.click("#reset")
    reader.settle()
    assert page.evaluate("report.values") == start
    page.wait_for_function("() => document.querySelectorAll('.pins tbody tr').length === 2")
    assert "mass" not in page.inner_text(".pins tbody tr >> nth=1")
    page.evaluate("report.put({...report.values, 'chair.m': 85})")
    reader.settle()
    page.wait_for_function(
        "() => document.querySelector('.pins tbody tr:nth-child(2)').innerText.includes('mass m of chair and user 85')"
    )
    page.wait_for_function("text => document.querySelector('.pins tbody td').innerText === text", arg=f"{TOP['heldout']:.2f}")
    page.click("[aria-label='go to A']")
    reader.settle()
    assert page.evaluate("report.values") == ticked


@pytest.mark.parametrize(
    "end",
    [
        "%7B%22values%22%3A%7B%22nonsense%22%3A1%7D%7D",
        "%E0%A4%A",
        "null",
        pytest.param("method", marks=pytest.mark.nightly),
        pytest.param("%22text%22", marks=pytest.mark.nightly),
    ],
)
def test_an_address_that_fits_nothing_is_passed_over(browser, report_file, open_report, end):
    opened = Reader(browser, report_file, end=f"#{end}")
    assert opened.page.evaluate("report.values") == open_report.page.evaluate("report.start.values")
    opened.close()


def test_the_way_past_the_text_keeps_the_state(reader):
    page = reader.page
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    page.evaluate("window.same = true")
    page.focus(".skip")
    page.keyboard.press("Enter")
    page.wait_for_function("() => scrollY > 0 && document.querySelector('#try').getBoundingClientRect().top < innerHeight / 2")
    page.wait_for_timeout(300)
    assert page.evaluate("window.same") and page.is_checked(f"#effect-{HIDDEN}")


@CHROMIUM
def test_without_scripts_the_story_is_there(browser, report_file):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(report_file.as_uri())
    assert page.locator(".card:visible").count() == 3 and page.locator(".screen:visible").count() == 5
    assert "needs JavaScript" in page.inner_text(".plea >> nth=0")
    context.close()


def test_one_time_for_chair_curves_and_readings(reader):
    page = reader.page
    over = page.locator("#overlay .u-over").first
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    page.mouse.move(box["x"] + box["width"] * 0.2, box["y"] + 20)
    page.mouse.down()
    page.mouse.move(box["x"] + box["width"] * 0.5, box["y"] + 40, steps=4)
    page.mouse.up()
    zoomed = page.evaluate("[report.timeline.from, report.timeline.to]")
    length = page.evaluate("report.timeline.time.at(-1)")
    assert zoomed == pytest.approx([0.2 * length, 0.5 * length], abs=0.02 * length)
    page.evaluate("report.timeline.zoom(2, 6), report.timeline.go(4)")
    page.wait_for_function("""() => [...document.querySelectorAll('.now-line')].every((line) => {
        const { left, width } = line.parentNode.getBoundingClientRect();
        return Math.abs((line.getBoundingClientRect().left - left) / width - 0.5) < 0.01;
    })""")  # half way from 2 to 6
    page.evaluate("report.timeline.go(3)")
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    assert page.evaluate("report.timeline.plots.map(p => [p.scales.x.min, p.scales.x.max])") == [[2, 6], [2, 6]]
    before = page.evaluate("report.scene.canvas.toDataURL()")
    page.evaluate("report.timeline.go(4)")
    assert page.evaluate("report.scene.canvas.toDataURL()") != before
    run = page.evaluate(
        "report.campaign.runs[report.shown.run].channels.yaw_rate[report.timeline.sample] * 180 / Math.PI"
    )  # its noise is 0.24 °/s
    told = page.inner_text('.readings tr[data-channel="yaw_rate"] td >> nth=0')
    assert float(told.removesuffix(" °/s").lstrip("−-")) == pytest.approx(abs(run), abs=0.006)
    page.select_option("[aria-label='speed of playing']", "4")
    page.click("[aria-label=play]")
    page.wait_for_function("() => report.timeline.at > 4.5")
    page.wait_for_function("() => !report.timeline.playing && report.timeline.at === 6")  # to the end of what is shown


def test_paper_shows_what_was_found_beside_what_was_before(reader):
    """Where nothing was set by hand; on the screen all stays as it is."""
    page, caption = reader.page, "#overlay .caption"
    page.wait_for_function("() => report.found?.run === report.shown.run")
    before = page.inner_text(caption)
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert "before (dashed)" in page.text_content(caption) and "before" in page.text_content("#overlay .paper svg")
    assert "before what was found was put in" in page.text_content("#where .caption")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    page.wait_for_function("() => !report.wished")
    assert page.inner_text(caption) == before and page.evaluate("report.timeline.result === report.results[report.shown.run]")
    page.check(f"#effect-{HIDDEN}")
    reader.settle()
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert "with the values that the search found" not in page.text_content(caption)
    page.evaluate("dispatchEvent(new Event('afterprint'))")


def test_on_a_phone_the_chair_moves_beside_its_curve(browser, report_file):
    """Between the top of the scene and the end of the first chart lies no more than a screen, less the numbers that stay."""
    reader = Reader(browser, report_file, 390)
    box = "(e) => { const { top, bottom } = e.getBoundingClientRect(); return [top, bottom]; }"
    scene = reader.page.eval_on_selector(".scenery", box)
    play, chart = (reader.page.eval_on_selector(s, box) for s in (".player", "#overlay .chart"))
    stays = reader.page.evaluate("document.querySelector('.now').offsetHeight")
    reader.close()
    assert scene[0] < play[0] < chart[0] and chart[1] - scene[0] < 860 - stays


def test_samples_of_several_devices_are_one_curve_and_a_pause_is_none(browser, tmp_path):
    """A channel that is sampled at every third row, with a pause of two seconds: drawn, read and printed as it is."""
    shutil.copytree(SAMPLE, tmp_path / "campaign")
    for file in (tmp_path / "campaign" / "runs").glob("*.csv"):
        rows = pd.read_csv(file)
        time = rows["time [s]"]
        rows.loc[(rows.index % 3 > 0) | ((time > 4) & (time < 6)), "yaw_rate [rad/s]"] = np.nan
        rows.to_csv(file, index=False)
    reader = Reader(browser, report_of(tmp_path / "campaign", tmp_path / "report.html"))
    page = reader.page
    page.evaluate("report.show(report.shown.run, 'yaw_rate')")
    page.wait_for_function(
        "() => report.timeline.channel === 'yaw_rate' && Number.isFinite(report.timeline.plots[0].scales.y.max)"
    )
    assert page.evaluate("report.timeline.plots.every(p => p.scales.y.min < p.scales.y.max)")
    gaps = page.evaluate("report.timeline.plots[0].series[1]._paths.gaps.length")  # of what was measured
    page.evaluate("report.timeline.go(3.02)")
    read = page.inner_text(".readings tr[data-channel=yaw_rate]")
    page.evaluate("report.written()")
    drawn = page.evaluate(
        "report.figures.all.overlay.says.draw(720, {}).querySelectorAll('path[stroke-width=\"1\"]')[0].getAttribute('d')"
    )
    reader.close()
    assert gaps == 1 and "–" not in read
    assert drawn.count("M") == 2 and drawn.count("L") > 100


def test_a_change_is_said_aloud(reader):
    reader.page.check(f"#effect-{HIDDEN}")
    reader.settle()
    reader.page.wait_for_function(
        "text => document.getElementById('said').innerText.includes(text)", arg=f"held out {TOP['heldout']:.2f}"
    )


@pytest.mark.parametrize("gone", ["WebAssembly", "Worker"])
def test_without_what_the_model_needs_one_sentence_and_what_is_stored(browser, report_file, gone):
    context = browser.new_context(offline=True)
    context.add_init_script(f"delete globalThis.{gone}")
    page, complaints = context.new_page(), []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(report_file.as_uri())
    page.wait_for_selector("#plea:visible")
    assert "cannot run the model" in page.inner_text("#plea")
    assert f"{TOP['heldout']:.2f}" in page.text_content("#staircase svg")
    assert page.locator("#forest svg").count() == 1
    assert page.is_hidden("#try") and page.locator(".card").count() == 3
    assert page.locator(".stage .guesses li").count() > 1
    assert page.is_hidden("#link") and page.is_hidden(".skip") and page.is_hidden("text=where the two curves part")
    context.close()
    assert not complaints


@pytest.mark.parametrize(("scheme", "width"), LOOKS)
def test_axe_finds_nothing_that_shuts_anyone_out(browser, report_file, width, scheme):
    """WCAG 2.2 AA, by axe-core, with everything open that can be opened."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="axe is not installed: make test-browser does")
    reader = Reader(browser, report_file, width, scheme)
    reader.page.check(f"#effect-{HIDDEN}")
    reader.settle()
    reader.page.evaluate("for (const d of document.querySelectorAll('details')) d.open = true")
    reader.page.add_style_tag(content="* { content-visibility: visible !important }")  # what is out of sight is judged as well
    found = axe.Axe().run(reader.page).response["violations"]
    said = [(v["id"], v["impact"], v["nodes"][0]["html"][:160]) for v in found]
    assert not [s for s in said if s[1] in ("critical", "serious", "moderate")], said
    reader.close()


def test_on_a_phone_a_tick_and_its_effect_are_on_one_screen(browser, report_file):
    reader = Reader(browser, report_file, 390)
    box = reader.page.locator(f"#effect-{HIDDEN}")
    box.scroll_into_view_if_needed()
    reader.page.evaluate("window.scrollBy(0, 200)")
    box.check()
    reader.settle()
    figure = reader.page.locator("#now-heldout").bounding_box()
    assert 0 <= figure["y"] < 844 and reader.page.inner_text("#now-heldout") == f"{TOP['heldout']:.2f}"
    curve = reader.page.locator(".mini").bounding_box()
    assert 0 <= curve["y"] < 844
    reader.close()


def test_on_a_phone_pictures_of_the_story_are_drawn_for_it(browser, report_file):
    """None is drawn for a wider place and shrunk, which nobody could read."""
    reader = Reader(browser, report_file, width=390)
    for i in range(5):
        reader.page.click(f".tab >> nth={i}")
        if i == 1:
            reader.page.click(".choice >> nth=0")
            reader.page.wait_for_selector(".screen:visible .curve svg")
        drawn = reader.page.evaluate("""[...document.querySelectorAll(".screen:not([hidden]) .stage svg")].map(
            (s) => s.getBoundingClientRect().width / s.viewBox.baseVal.width)""")
        assert all(scale > 0.95 for scale in drawn) and (drawn or i == 4), i
    reader.close()


def test_names_of_any_length_and_character(browser, report_file, tmp_path):
    content = unpacked(report_file.read_text(encoding="utf-8"))
    story = Story([{"head": "What", "lead": "ß" * 300, "lines": []}], content["story"]["screens"])
    content["name"] = "<b>&amp;" + "Wägelchen_" * 30
    for i, run in enumerate(content["runs"]):
        run["name"] = f"{i}" + ["\"quote'", "</script>", "輪椅" * 60, "x" * 250, "e\u0301\u202e"][i % 5]
    file = tmp_path / "odd.html"
    file.write_text(page_of(content, "a" * 400, [], story), encoding="utf-8")
    for width in (1280, 390):
        reader = Reader(browser, file, width)
        assert reader.page.evaluate("document.documentElement.scrollWidth") <= width
        reader.close()


@pytest.mark.parametrize(
    "verdict",
    ["tie", "outside", "cannot_see", *(pytest.param(v, marks=pytest.mark.nightly) for v in ("small", "adequate", "missing"))],
)
def test_every_verdict_opens_with_three_cards_and_five_screens(browser: Any, tmp_path: Path, verdict: str) -> None:
    """A diagnosis of the sample campaign that says something else, which is enough for the page."""
    told = json.loads(DIAGNOSIS.read_text())
    pair = [HIDDEN, "floor_cross_slope"]
    told["verdict"] = verdict
    told["effects"] = {"tie": pair, "missing": pair, "small": [HIDDEN]}.get(verdict, [])
    told["ties"] = [pair] if verdict == "tie" else []
    if verdict in ("adequate", "cannot_see"):  # the search ends where it began
        told["ladder"], told["models"] = told["ladder"][:2], told["models"][:2]
    for row in told["ranking"]:
        row["verdict"] = verdict if row["effect"] in told["effects"] else "not needed"
    if verdict == "missing":
        sizes = {
            f"effect.{HIDDEN}.D": {"estimate": 1.6, "se": 0.1},
            "effect.floor_cross_slope.theta": {"estimate": 0.1, "se": None},
        }
        told["groups"] = [{"effects": pair, "beside": [], "parameters": sizes, "p": 1e-9, "lr": 9.0, "found": True}]
    if verdict == "tie":
        readings = {e: [1.0, k, 0.0] for e, k in zip(pair, (0.5, 0.4), strict=True)}
        shows = {"channel": "wheel_speed_l", "time": [0.0, 1.0, 2.0], "readings": readings, "noise": 0.05}
        told["next_experiment"] = {"manoeuvre": "a coast-down", "separates": pair, "repeats": 1, "why": "", "shows": shows}
    if verdict == "outside":
        panel = {"variable": "speed", "unit": "m/s", "knots": [0, 1, 2], "estimate": [None, 0.5, 1.0], "se": [None, 0.1, 0.2]}
        told["missing"] = {"words": "force along the chair", "unit": "N", "panels": [panel]}
    (tmp_path / "told.json").write_text(json.dumps(told))
    reader = Reader(browser, report_of(SAMPLE, tmp_path / "report.html", tmp_path / "told.json"))
    assert reader.page.locator(".card").count() == 3
    assert reader.page.is_visible("#missing") == (verdict == "outside")
    if verdict == "outside":  # its caption has a number
        assert "it is 1.00 ± 0.20 N at a speed of 2.0 m/s." in reader.page.text_content("#missing .caption")
    assert reader.page.locator("#ties #joint svg").count() == (verdict == "tie")
    assert reader.page.locator("#next .drawing svg").count() == (verdict == "tie")
    assert reader.page.locator(".several tbody tr").count() == (verdict == "missing")
    assert "[object" not in reader.page.text_content("main")
    for width in (1280, 390):
        reader.page.set_viewport_size({"width": width, "height": 900})
        reader.page.wait_for_function(f"() => document.querySelector('#staircase svg').viewBox.baseVal.width < {width}")
        for i in range(5):
            reader.page.click(f".tab >> nth={i}")
            assert reader.page.locator(".screen:visible > h3").inner_text()
            assert reader.page.evaluate(FAULTS) == [], (width, i)
    assert reader.page.is_visible("#link")  # on a phone as well
    assert "_" not in reader.page.inner_text("h1") + reader.page.inner_text(".screen:visible > h3")
    reader.close()


def test_where_nothing_is_missing_the_largest_error_is_shown_until_one_is_put_in(browser: Any, tmp_path: Path) -> None:
    """Then the page turns to where it parts the model from the readings, as over all of them the error hardly rises."""
    told = json.loads(DIAGNOSIS.read_text()) | {"verdict": "adequate", "effects": [], "ties": []}
    told["ladder"], told["models"] = told["ladder"][:2], told["models"][:2]
    (tmp_path / "told.json").write_text(json.dumps(told))
    reader = Reader(browser, report_of(SAMPLE, tmp_path / "report.html", tmp_path / "told.json"))
    reader.page.wait_for_timeout(1000)
    errors = """(results) => Math.max(...report.campaign.runs.flatMap((run, i) => run.role !== "holdout" ? [] :
        Object.keys(run.channels).map((c) => results[i].squares[c] / results[i].counts[c])))"""
    shown = "(r => r.squares[report.shown.channel] / r.counts[report.shown.channel])(report.opened[report.shown.run])"
    assert reader.page.evaluate(shown) == reader.page.evaluate(f"({errors})(report.opened)")
    reader.page.click(".tab >> nth=2")
    reader.page.click(".screen:visible .big")
    reader.settle()
    rise = "(i, channel) => report.results[i].squares[channel] - report.opened[i].squares[channel]"
    most = reader.page.evaluate(f"""() => Math.max(...report.campaign.runs.flatMap((run, i) => run.role !== "holdout" ? [] :
        Object.keys(run.channels).map((c) => ({rise})(i, c) / report.opened[i].counts[c])))""")
    here = f"({rise})(report.shown.run, report.shown.channel) / report.opened[report.shown.run].counts[report.shown.channel]"
    assert reader.page.evaluate(here) == most > 0
    parted = reader.page.evaluate("report.shown")
    told = reader.page.inner_text(".counter")
    assert "in this run and channel" in told
    before, after = map(float, re.findall(r"\d+\.\d\d", told))
    assert after > before and after == pytest.approx(np.sqrt(before**2 + most), abs=0.02)
    reader.page.click(".tab >> nth=0")  # which tells of the largest error still
    assert reader.page.evaluate(shown) == reader.page.evaluate(f"({errors})(report.opened)")
    reader.page.click(".tab >> nth=2")
    assert reader.page.evaluate("report.shown") == parted != reader.page.evaluate("report.left")
    reader.close()


def test_a_calibrated_value_is_marked_where_it_was_fitted_with_what_is_in(reader):
    """Before an effect is in, and with it."""
    mark = "document.getElementById('slider-resistance.f_r-help').textContent"
    fitted = lambda step: next(m["values"] for m in TOLD["models"] if m["step"] == step)["resistance.f_r"]  # noqa: E731
    told = lambda: float(re.search(r"fitted ([\d.]+)", reader.page.evaluate(mark))[1])  # noqa: E731
    assert told() == pytest.approx(fitted("calibrated"), rel=5e-3)
    reader.page.check(f"#effect-{HIDDEN}")
    reader.settle()
    assert told() == pytest.approx(fitted(f"+{HIDDEN}"), rel=5e-3) != fitted("calibrated")


def test_a_curve_of_a_size_ends_where_it_is_beyond_what_is_drawn(open_report):
    """Further off, a search may have found another model."""
    rising = open_report.page.evaluate(
        "import('page/landscape').then((m) => m.rising([2, 20, 12, 4, 0, 1, 9, 13, 6, null], 9))"
    )
    assert rising == [None, None, 12, 4, 0, 1, 9, None, None, None]


LETTERS = Path(__file__).with_name("letters.js").read_text()


def test_print_of_much_to_tell_is_two_pages_as_well(browser, tmp_path):
    """A tie beside what is sure, forces that nobody recorded, and seven steps; letters keep the size that one can read."""
    told = json.loads(DIAGNOSIS.read_text())
    first, second, third = (r["effect"] for r in told["ranking"][:3])
    (nominal, calibrated, last), led = told["ladder"], {**told["ladder"][1], "step": "unrecorded forces"}
    turns = {**led["channels"]["yaw_rate"], "heldout": 2.5, "heldout_rms": 0.9}
    led["channels"] = {**led["channels"], "yaw_rate": turns}
    between = [{**calibrated, "step": f"+{r['effect']}"} for r in told["ranking"][3:5]]
    told |= {
        "verdict": "tie",
        "effects": [first, second, third],
        "ties": [[second, third]],
        "odds": [{second: 0.9, third: 0.1}],
    }
    told["ladder"] = [nominal, calibrated, led, *between, {**last, "step": f"+{first}"}, {**last, "step": f"+{second}"}]
    told["noise"] |= {"force": 1.0, "moment": 0.2, "body": 0.5, "lasting": 0.5, "mass": 80.0}
    (tmp_path / "told.json").write_text(json.dumps(told))
    reader = Reader(browser, report_of(SAMPLE, tmp_path / "report.html", tmp_path / "told.json"))
    printed = reader.page.pdf(prefer_css_page_size=True, print_background=True)
    assert pages_of(printed) == 2
    assert "missed by 0.90 °/s before" in reader.page.inner_text(".cards")  # what forces brought down is no effect's work
    reader.page.set_viewport_size({"width": 703, "height": 1000})
    reader.page.emulate_media(media="print")
    smallest, words = reader.page.evaluate(LETTERS)
    assert smallest >= 6.5, words
    reader.close()


def test_constants_of_laws_have_words_in_figures(browser, tmp_path):
    told = json.loads(DIAGNOSIS.read_text())
    told["calibration"]["effect.caster_friction.rate"] = {
        "value": 0.08,
        "se": 0.01,
        "prior": 0.02,
        "prior_sd": 0.03,
        "at_bound": False,
    }
    (tmp_path / "told.json").write_text(json.dumps(told))
    reader = Reader(browser, report_of(SAMPLE, tmp_path / "report.html", tmp_path / "told.json"))
    assert "Effect." not in reader.page.text_content("#calibration svg")
    assert "no two bearings" in reader.page.text_content("#calibration svg")
    reader.close()


def test_print_is_two_pages_on_white(browser, report_file):
    reader = Reader(browser, report_file, scheme="dark")
    reader.page.check(f"#effect-{HIDDEN}")
    reader.settle()
    printed = reader.page.pdf(prefer_css_page_size=True, print_background=True)
    assert pages_of(printed) == 2
    reader.close()
