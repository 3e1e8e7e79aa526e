"""The workbench in a real browser: from an empty start to an exported FMU that fmpy runs."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest

from tests.browser.conftest import DIAGNOSIS, LOOKS, PATIENCE, SAMPLE, handed_out
from tests.campaign import lab

RUNS = ("coast-down", "random-steps", "slalom-quick", "holdout-random")  # which show the effect, and are soon diagnosed
LONG = 300_000  # ms for a diagnosis, models compiled for the first time, on a busy machine


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    opened, complaints = context.new_page(), []
    opened.set_default_timeout(PATIENCE)
    opened.on("pageerror", lambda error: complaints.append(str(error)))
    opened.goto(address)
    yield opened
    context.close()
    assert not complaints


def take_in(page: Any, *files: Path) -> None:
    page.set_input_files("#files", [str(f) for f in files])
    page.wait_for_function("n => window.workbench?.state?.files.length === n", arg=len(files))  # they go one by one


def typed(field: Any, words: str) -> None:
    """Key by key, and on to the next field: what a script puts into a field is no change to every browser."""
    field.fill("")
    field.press_sequentially(words)
    field.press("Tab")


def recordings() -> list[Path]:
    return [SAMPLE / "runs" / f"{name}.csv" for name in RUNS]


def done(page: Any, kind: str) -> None:
    page.wait_for_function(
        "kind => (({job}) => job?.kind === kind && job.state !== 'running')(window.workbench?.state ?? {})",
        arg=kind,
        timeout=LONG,
    )
    assert page.evaluate("workbench.state.job.state") == "done", page.inner_text("#job")


def test_from_an_empty_start_to_an_improved_fmu(page: Any, tmp_path: Path) -> None:
    take_in(page, *recordings())
    assert page.inner_text("#faults b") == "These recordings can be read."
    page.click("#diagnose")
    page.wait_for_function("() => document.getElementById('job').textContent.includes('calibrating')", timeout=LONG)  # live
    assert "step" in page.inner_text("#progress") and "so far" in page.inner_text("#progress")
    page.reload()  # and nothing is lost
    done(page, "diagnose")
    assert "rolls harder" in page.inner_text("#outcome h3")
    assert page.locator("#outcome .card").count() == 3 and "_" not in page.inner_text("#outcome")
    assert page.input_value("#effect") == "rolling_resistance_asymmetry"  # the likeliest comes first
    with page.context.expect_page() as opened:
        page.click("#report")
    report = opened.value
    report.check("#effect-rolling_resistance_asymmetry")
    report.wait_for_selector("#status[data-state=exact]")
    report.close()
    page.click("text=add it: one rear wheel that rolls harder")
    assert page.is_visible("#dock")  # at once, and wherever one looks
    done(page, "add")
    assert re.search(r"Added: one rear wheel.* falls from [\d.]+ to [\d.]+ times the noise", page.inner_text("#progress"))
    page.click("#see")
    assert page.is_hidden("#dock")
    assert re.search(r"as given [\d.]+ → calibrated [\d.]+ → now [\d.]+", page.inner_text("#history li[aria-current]"))
    offered = page.locator("#effect option").evaluate_all("options => options.map(o => o.value)")
    assert "rolling_resistance_asymmetry" not in offered  # it is in
    page.wait_for_selector("#old-report:visible")  # the report does not know the effect yet
    assert "diagnose again" in page.inner_text("#export-why")
    assert page.locator("#outcome [data-add=rolling_resistance_asymmetry]").count() == 0
    file = tmp_path / "Better.fmu"
    file.write_bytes(handed_out(page, lambda: page.click("#export-fmu"))[1])
    starts = {v.name: v.start for v in fmpy.read_model_description(str(file)).modelVariables}
    assert float(starts["effect.rolling_resistance_asymmetry.D"]) == pytest.approx(1.6, abs=0.15)
    result = fmpy.simulate_fmu(str(file), stop_time=1.0, output=["chair.psi"])
    assert result["chair.psi"][-1] < 0  # the left wheel drags, so the chair turns left
    values = handed_out(page, lambda: page.click("#export-ssv"))[1]
    assert b'name="effect.rolling_resistance_asymmetry.D"' in values
    page.click("#undo")
    page.wait_for_function("() => workbench.state.history.at === 0")
    assert page.inner_text("#history li[aria-current]") == "The model as given"
    page.wait_for_selector("#old-report", state="detached")
    page.click("#redo")
    page.wait_for_function("() => workbench.state.history.at === 1")


def test_bad_files_show_their_faults_in_the_page(page: Any, tmp_path: Path) -> None:
    bad = tmp_path / "bad.csv"
    bad.write_text("time [s],F_rl [N],F_rr [N],yaw_rate [furlong]\n0,1,2,3\n0,1,two,3\n")
    take_in(page, bad)
    faults = page.inner_text("#faults")
    assert "faults to mend" in faults and "find out above" in faults
    assert "Unit 'furlong' measures a length" in faults
    assert "'two' is not a number" in faults
    assert page.is_disabled("#diagnose") and "mend above" in page.inner_text("#why")
    assert "[columns]" not in faults and "constant =" not in faults  # of which nothing is in the page
    beside = page.locator("#forms tr", has=page.locator("th", has_text="yaw_rate")).locator(".wrong")
    assert "measures a length" in beside.inner_text()
    typed(page.locator('[aria-label="unit of yaw_rate [furlong]"]'), "deg/s")
    page.wait_for_function("() => !document.getElementById('faults').innerText.includes('measures a length')")
    assert beside.inner_text() == ""


def test_a_size_that_was_no_number_can_be_put_right(page: Any) -> None:
    page.wait_for_function("() => window.workbench?.state")
    size = page.locator("input[name=size]")
    for words, told in (("much", "give a number, as in 0.5"), ("0,25", "")):
        size.evaluate("(e) => e.closest('details')?.setAttribute('open', '')")
        size.evaluate("(e, words) => { e.value = words; e.dispatchEvent(new Event('input')); }", words)
        assert size.evaluate("(e) => e.validationMessage") == told


def test_what_points_left_in_a_file_is_said_beside_its_column(page: Any) -> None:
    page.click("#sample")
    page.wait_for_function("() => window.workbench?.state?.files.length === 10")
    page.evaluate("workbench.save((c) => { c.campaign.axes = 'ISO-8855'; })")
    page.wait_for_function("() => document.querySelector('#forms .columns').textContent.includes('points to the left')")
    rows = page.locator("#forms .columns tbody tr").filter(has_text="points to the left")
    assert [row.locator("th").text_content().split()[0] for row in rows.all()] == ["yaw_rate", "a_y"]


def test_a_misspelt_column_is_asked_after_where_it_is_named(page: Any, tmp_path: Path) -> None:
    time = np.arange(0, 5, 0.02)
    names = ["time [s]", "F_rl [N]", "F_rr [N]", "wheel_speed_l [m/s]", "wheel_sped_r [m/s]", *(f"more {i}" for i in range(20))]
    rows = [",".join(names), *(",".join(f"{t:.4f}" for _ in names) for t in time)]
    (tmp_path / "run.csv").write_text("\n".join(rows))
    take_in(page, tmp_path / "run.csv")
    row = page.locator("#forms .columns tbody tr", has=page.locator("th", has_text="wheel_sped_r"))
    assert row.is_visible() and "It looks like the right wheel's speed, but is not used" in row.locator(".wrong").inner_text()
    page.select_option('[aria-label="channel of wheel_sped_r [m/s]"]', "wheel_speed_r")
    page.wait_for_function("() => !document.querySelector('#forms .columns').innerText.includes('looks like')")
    assert page.evaluate("workbench.state.campaign.columns.wheel_speed_r.column") == "wheel_sped_r [m/s]"


def test_the_keyboard_goes_on_from_the_section_whose_button_is_gone(page: Any) -> None:
    page.wait_for_function("() => window.workbench?.state")
    page.focus("#sample")
    page.keyboard.press("Enter")
    page.wait_for_function("() => window.workbench?.state?.files.length === 10")
    page.wait_for_function("() => document.activeElement.id === 'measurements-title'")
    page.focus("#diagnose")
    page.keyboard.press("Enter")
    page.wait_for_function("() => document.activeElement.id === 'work-title'")
    page.click("#cancel")
    page.wait_for_function("() => workbench.state.job.state !== 'running'", timeout=LONG)


def test_a_value_that_is_no_number_is_no_reason_to_read_the_files_anew(page: Any) -> None:
    """Which would write over all other values."""
    page.click("#sample")
    page.wait_for_function("() => window.workbench?.state?.files.length === 10")
    page.evaluate("workbench.save((c) => { c.chair.m = 'heavy'; })")
    page.wait_for_function("() => document.getElementById('faults').innerText.includes('heavy')")
    assert "find out" not in page.inner_text("#faults") and page.is_hidden("#lab")
    told = page.locator("[data-at='chair.m']")
    assert "'heavy' is not a finite number" in told.text_content() and "guess" not in told.get_attribute("class")
    assert page.locator("input[aria-label^='chair.m:']").get_attribute("aria-invalid") == "true"
    page.click("#undo")
    page.wait_for_function("() => document.getElementById('faults').innerText.includes('can be read')")


def test_a_run_without_recorded_pushes_is_mended_where_it_stands(page: Any, tmp_path: Path) -> None:
    """And of a file of many columns, those that nothing is taken from are folded."""
    time = np.arange(0, 5, 0.02)
    more = {f"channel {i}": time for i in range(30)}
    columns = {"time [s]": time, "wheel_speed_l [m/s]": 1 - 0.1 * time, "wheel_speed_r [m/s]": 1 - 0.1 * time, **more}
    text = (
        ",".join(columns) + "\n" + "\n".join(",".join(map("{:.4f}".format, row)) for row in zip(*columns.values(), strict=True))
    )
    (tmp_path / "coast.csv").write_text(text)
    take_in(page, tmp_path / "coast.csv")
    rows = page.locator("#forms .columns tbody tr")
    assert rows.count() == 33 and sum(row.is_visible() for row in rows.all()) == 3
    assert "The push on the left wheel is missing" in page.inner_text("#forms .runs .wrong")
    page.select_option('[aria-label="pushes in coast.csv"]', "none")
    page.wait_for_function("() => workbench.state.campaign.run[0].constant?.F_rr === 0")
    assert page.inner_text("#forms .runs .wrong") == "" and "push" not in page.inner_text("#faults")


def test_what_is_refused_is_said_beside_what_was_used(page: Any) -> None:
    page.wait_for_function("() => window.workbench?.state")
    for name, words in {"id": "brake", "title": "a brake", "expression": "-q * u"}.items():
        page.fill(f"#own [name={name}]", words)
    size = (
        "value => { document.querySelector('#own [name=size]').value = value; }"  # not every browser's driver empties it first
    )
    page.evaluate(size, "200")
    page.click("#own button[type=submit]")
    page.wait_for_selector("#own #error:visible")
    assert "“greatest q” above that" in page.inner_text("#error")
    page.evaluate(size, "0.5")
    page.click("#own button[type=submit]")
    page.wait_for_selector("#error", state="hidden")
    page.wait_for_function("() => document.getElementById('tried').textContent.includes('once there are recordings')")


def test_a_workbench_that_has_ended_says_how_to_go_on(page: Any) -> None:
    page.wait_for_function("() => window.workbench?.state")
    page.route("**/sample", lambda route: route.abort())
    page.click("#sample")
    page.wait_for_selector("#dock #error:visible")
    assert "your work is kept" in page.inner_text("#error")
    page.unroute("**/sample")
    page.click("#sample")
    page.wait_for_function("() => window.workbench?.state?.files.length === 10")
    assert page.is_hidden("#error") and page.is_hidden("#dock")


def test_what_another_tab_has_changed_is_seen_on_coming_back(page: Any) -> None:
    take_in(page, *recordings())
    other = page.context.new_page()
    other.goto(page.url)
    other.click("summary >> text=Noise of the sensors")
    typed(other.locator("label", has_text="yaw_rate").locator("input").last, "0.5 deg/s")
    other.wait_for_function("() => workbench.state.campaign.noise?.yaw_rate")
    other.close()
    page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    page.wait_for_function("() => workbench.state.campaign.noise?.yaw_rate === '0.5 deg/s'")


def test_files_of_loggers_are_asked_about_in_words_and_lengths(page: Any, tmp_path: Path) -> None:
    """What no file tells is asked for beside a drawing of the chair; once the files are read the question folds, and holds what
    was said, also of a page that is opened again."""
    rng = np.random.default_rng(1)
    for i, ride in enumerate(lab.rides(1), 1):
        lab.rim(tmp_path / f"run{i:02d}_SWL.csv", ride, 0.7, "l", rng)
        lab.rim(tmp_path / f"run{i:02d}_SWR.csv", ride, 0.2, "r", rng, mirrored=True)
    take_in(page, *sorted(tmp_path.iterdir()))
    assert "Which column is what is not known yet" in page.inner_text("#faults")
    assert page.is_hidden("#forms") and "push on" not in page.inner_text("#faults")  # no faults of what was not asked yet
    assert (
        page.is_visible("#lab svg") and page.locator("[aria-label^='unit of']:visible").count() == 0
    )  # no table of columns to mend
    for words, size in {"mass of chair and rider": 90, "radius of": lab.RADIUS, "A rear axle": 0.44, "B centre": 0.1}.items():
        typed(page.locator("#lab label", has_text=words).locator("input"), str(size))
    typed(page.locator("#lab [name=caster_trail]"), "50 mm")
    typed(page.locator("#lab [name=wheel_inertia]"), "0.12 kg m2")
    page.click("#import")
    done(page, "import")
    page.wait_for_function("() => workbench.state.campaign.chair?.b === 0.1")
    assert page.evaluate("workbench.state.campaign.effect.caster_trail.c") == 0.05
    assert page.evaluate("workbench.state.campaign.chair") == {"m": 90, "a": 0.34, "b": 0.1}
    assert not page.is_visible("#import") and page.inner_text("#faults b") == "These recordings can be read."
    assert "how far the rear wheels are apart" in page.inner_text("#assumed")
    page.reload()
    page.wait_for_selector("#lab")
    page.click("#lab > summary")
    assert page.input_value("#lab [name=wheelbase]") == "0.44" and page.input_value("#lab [name=person]") == ""
    assert abs(float(page.input_value("#lab [name=wheel_inertia]")) - 0.12) < 1e-4


def test_an_answer_that_comes_late_does_not_hide_what_came_after(page: Any) -> None:
    """The state before the files were read, asked for first, is answered last."""
    page.wait_for_function("() => window.workbench?.state")
    page.evaluate("""() => {
        const states = [{...workbench.state, files: ['late']}, {...workbench.state, files: ['new']}];
        const shown = workbench.show;
        window.seen = [];
        workbench.show = (state) => { window.seen.push(state.files[0]); };
        const late = new Promise((resolve) => setTimeout(() => resolve(states[0]), 300));
        workbench.take(() => late);
        workbench.take(() => Promise.resolve(states[1])).then(() => { workbench.show = shown; });
    }""")
    page.wait_for_function("() => window.seen.length === 2")
    assert page.evaluate("window.seen") == ["late", "new"]


def test_cancelling_leaves_things_as_they_were(page: Any) -> None:
    take_in(page, *recordings())
    page.click("#diagnose")
    page.wait_for_function("() => document.getElementById('job').textContent.includes('calibrating')", timeout=LONG)
    page.click("#cancel")
    page.wait_for_function("() => workbench.state.job?.state === 'cancelled'", timeout=LONG)
    page.wait_for_function("() => document.getElementById('progress').textContent.includes('nothing was changed')")
    assert page.is_enabled("#diagnose")
    assert page.is_hidden("#outcome")


def test_the_sample_is_there_to_try(page: Any) -> None:
    page.click("#sample")
    page.wait_for_function("() => window.workbench?.state?.files.length === 10")
    assert page.inner_text("#faults b") == "These recordings can be read."
    assert page.inner_text("#name") == "sample-chair" and page.is_hidden("#sample")
    assert page.locator(".signal svg:visible").count() == 0  # what can be read is folded
    page.click("text=Columns and their units")
    assert page.locator(".signal svg:visible").count() == len(page.evaluate("Object.keys(workbench.state.headers)"))
    with page.context.expect_page() as opened:
        page.click("#preview")
    opened.value.wait_for_selector("text=Nothing odd was found")
    opened.value.set_viewport_size({"width": 390, "height": 844})
    assert opened.value.evaluate("document.documentElement.scrollWidth") <= 390
    assert opened.value.locator("svg").first.evaluate("e => e.getBoundingClientRect().width") > 800  # and scrolls, to be read
    assert opened.value.locator("svg").count() >= 1
    opened.value.close()


def test_columns_of_devices_are_told_by_what_they_serve(page: Any) -> None:
    """What is used comes first and the rest is folded; a column from which others are worked out, and one that is turned round,
    say so; what was taken from another chair is said beside the button. The state is what an import leaves behind."""
    take_in(page, *recordings())
    page.evaluate("""() => {
        const state = structuredClone(workbench.state), [first, second] = Object.keys(state.headers);
        const columns = {wheel_angle_l: {column: first, sign: -1}, F_rl: {column: second}};
        state.campaign.recording = [{device: "rim", columns}];
        state.campaign.run = state.campaign.run.map((run) => ({...run, files: {rim: run.file}}));
        delete state.campaign.chair;
        workbench.show(state);
    }""")
    used, rest = page.locator("#forms tr[data-used]"), page.locator("#forms details details tbody tr")
    assert used.count() == 2 and rest.count() == len(page.evaluate("Object.keys(workbench.state.headers)")) - 2
    chosen = used.first.locator("select").evaluate("e => e.selectedOptions[0].textContent")
    assert chosen == "left wheel angle, from which other signals are worked out"
    assert page.locator("#forms h3", has_text="Of no device").count() == 0
    page.evaluate("""() => {
        const state = structuredClone(workbench.state), [first] = Object.keys(state.headers), [run] = state.campaign.run;
        state.files.push("late.csv");
        state.headers = {...state.headers, [first]: [...state.headers[first], "late.csv"]};
        const guess = {severity: "guess", what: "rad by its size: check it", where: "rim", text: ""};
        state.faults.push({...guess, file: run.file, column: first});
        workbench.show(state);
    }""")
    lone = page.locator("#forms div", has=page.locator("> h3", has_text="Of no device"))
    assert "late.csv" in lone.locator("h3").inner_text() and lone.locator("> .wide > table tbody tr").count() == 1
    assert "rad by its size: check it." in page.locator("#forms .guess").all_text_contents()
    assert "1 to look at" in page.inner_text("#faults details[open] > summary")
    assert "turned round" in used.first.inner_text() and not rest.first.is_visible()
    assert "how far the rear axle is behind it" in page.inner_text("#assumed")


def test_two_tabs_are_two_pieces_of_work(page: Any, address: str) -> None:
    take_in(page, *recordings())
    other = page.context.new_page()
    other.goto(address)
    other.wait_for_function("() => window.workbench?.state")
    assert other.url != page.url
    assert other.evaluate("workbench.state.files") == []
    assert other.locator("#earlier a").count() >= 1


def test_what_was_asked_on_coming_back_does_not_hide_what_was_done_meanwhile(page: Any) -> None:
    """The state of an empty start is answered after the sample was taken in."""
    page.wait_for_function("() => window.workbench?.state")
    page.evaluate("""() => {
        const ask = window.fetch;
        let first = true;
        window.fetch = async (...asked) => {
            const answer = await ask(...asked);
            if (!first || !String(asked[0]).endsWith("/state")) return answer;
            first = false;
            await new Promise((resolve) => { window.release = resolve; });
            setTimeout(() => workbench.take(() => Promise.resolve(workbench.state)).then(() => { window.all = true; }), 500);
            return answer;
        };
        document.dispatchEvent(new Event("visibilitychange"));
    }""")
    page.wait_for_function("() => window.release")
    page.click("#sample")
    page.wait_for_function("() => workbench.state.files.length === 10")
    page.evaluate("release()")
    page.wait_for_function("() => window.all")
    assert page.evaluate("workbench.state.files.length") == 10


def test_noise_and_priors_are_a_form_whose_changes_can_be_undone(page: Any) -> None:
    take_in(page, *recordings())
    page.click("summary >> text=Noise of the sensors")
    field = page.locator("label", has_text="yaw_rate").locator("input").last
    assert "rad/s" in field.get_attribute("placeholder")
    typed(field, "0.5 deg/s")
    page.wait_for_function("() => workbench.state.campaign.noise?.yaw_rate === '0.5 deg/s'")
    page.click("text=How sure these values are")
    prior = page.locator('input[aria-label^="prior of chair.I_z:"]')
    typed(prior, "0.2")
    page.wait_for_function("() => workbench.state.campaign.prior?.chair?.I_z === 0.2")
    assert page.inner_text("#history li[aria-current]") == "The model as given"  # forms make no models
    assert page.get_attribute("#undo", "title") == "undo: prior of chair.I_z = 0.2"
    page.click("#undo")
    page.wait_for_function("() => workbench.state.campaign.prior?.chair?.I_z === undefined")
    assert page.evaluate("workbench.state.campaign.noise.yaw_rate") == "0.5 deg/s"
    page.click("#undo")
    page.wait_for_function("() => !workbench.state.campaign.noise")


def test_values_that_are_typed_fast_are_all_kept(page: Any) -> None:
    """Each change is sent on its own, after the one before it: what was typed meanwhile is not lost."""
    take_in(page, *recordings())
    page.click("text=What is known of the chair")
    values = {"chair.I_z": 3.3, "tyre.C_lambda": 5047, "resistance.f_r": 0.011, "resistance.f_f": 0.019}
    for name, value in values.items():
        typed(page.locator(f'input[aria-label^="{name}:"]'), str(value))
    page.wait_for_function("() => workbench.saving === 0 && workbench.state.campaign.resistance?.f_f === 0.019")
    page.reload()
    page.wait_for_function("() => window.workbench?.state?.files.length")
    kept = page.evaluate("(({chair, tyre, resistance}) => ({...chair, ...tyre, ...resistance}))(workbench.state.campaign)")
    assert kept == {name.rpartition(".")[2]: value for name, value in values.items()}


def test_a_form_stays_open_while_what_is_wrong_in_it_is_mended(page: Any) -> None:
    take_in(page, *recordings())
    page.click("text=What is known of the chair")
    mass = page.locator('input[aria-label^="chair.m:"]')
    for value in ("eighty", "80"):
        typed(mass, value)
        page.wait_for_function("() => workbench.saving === 0")
        assert mass.is_visible()
    assert page.evaluate("workbench.state.campaign.chair.m") == 80


def test_a_column_can_be_turned_round(page: Any) -> None:
    take_in(page, *recordings())
    page.click("text=Columns and their units")
    for on in (True, False):
        page.get_by_label("yaw_rate [rad/s] turned round").set_checked(on)
        page.wait_for_function("() => workbench.saving === 0")
        entry = page.evaluate("workbench.state.campaign.columns?.yaw_rate ?? null")
        assert entry == ({"column": "yaw_rate [rad/s]", "sign": -1} if on else None)
        differ = "() => workbench.state.faults.some((f) => f.what.includes('sign of yaw_rate'))"
        assert page.evaluate(differ) == on
    page.get_by_label("yaw_rate [rad/s] turned round").check()
    for unit in ("deg/s", "rad/s"):  # and back to what the header says
        page.get_by_label("unit of yaw_rate [rad/s]").fill(unit)
        page.get_by_label("unit of yaw_rate [rad/s]").press("Tab")
        page.wait_for_function("() => workbench.saving === 0")
        assert page.evaluate("workbench.state.campaign.columns.yaw_rate.sign") == -1


def test_a_signal_that_goes_to_another_column_is_said(page: Any, tmp_path: Path) -> None:
    time = np.arange(0, 4, 0.02)
    names = ("time [s]", "first [m/s]", "second [m/s]")
    np.savetxt(tmp_path / "a.csv", np.c_[time, 1 + 0 * time, 1 + 0 * time], delimiter=",", header=",".join(names), comments="")
    take_in(page, tmp_path / "a.csv")
    if page.locator("#faults details > summary").count():
        page.click("#faults details > summary")
    for name in names[1:]:
        page.select_option(f'select[aria-label="channel of {name}"]', "u")
        page.wait_for_function("() => workbench.saving === 0")
    assert "“first [m/s]” was the u before, and is not used now." in page.inner_text("#remark")
    assert page.input_value(f'select[aria-label="channel of {names[1]}"]') == ""
    assert page.input_value(f'select[aria-label="channel of {names[2]}"]') == "u"


def test_where_a_device_sits_is_understood_with_points_and_with_commas(page: Any) -> None:
    said = {"0.09, 0.04": [0.09, 0.04], "0.09,4": [0.09, 4], "0,09 0,04": [0.09, 0.04], "0,09; -0,04": [0.09, -0.04]}
    none = ("9 cm, 4 cm", "left", "0.09", "1 2 3")
    found = page.evaluate(
        "async (all) => { const { pointOf } = await import('page/forms'); return all.map(pointOf); }", [*said, *none]
    )
    assert found == [*said.values(), *(None for _ in none)]


def test_where_each_channel_is_read_is_typed_beside_it(page: Any) -> None:
    """Of those for which it matters: accelerations, positions and speeds, whichever device has them."""
    take_in(page, *recordings())
    page.evaluate("for (const d of document.querySelectorAll('#forms details')) d.open = true")
    places = page.locator("#forms .columns input[aria-label^='where ']")
    told = [f"where {name} is read" for name in ("forward acceleration", "sideways acceleration")]
    assert places.evaluate_all("all => all.map(e => e.getAttribute('aria-label'))") == told
    places.nth(1).fill("0,11 -0,04")
    places.nth(1).press("Enter")
    page.wait_for_function("() => workbench.state.campaign.sensor?.a_y?.at?.join() === '0.11,-0.04'")
    places.nth(1).fill("left")
    places.nth(1).press("Enter")
    said = page.locator("#forms .wrong", has_text="sideways acceleration is read is no point; give two numbers in metres")
    said.wait_for()
    places.nth(1).fill("")
    places.nth(1).press("Enter")
    page.wait_for_function("() => !workbench.state.campaign.sensor")
    said.wait_for(state="detached")


def test_a_device_of_positions_or_markers_has_a_place_as_well(page: Any) -> None:
    take_in(page, *recordings())
    page.evaluate("""() => {
        const state = structuredClone(workbench.state), [first, second] = Object.keys(state.headers);
        const laser = {device: "laser", columns: {u: {column: first}}};
        const gyro = {device: "gyro", columns: {yaw_rate: {column: second}}};
        state.campaign.recording = [laser, gyro, {device: "cameras", columns: {}, markers: {axle_l: "L", axle_r: "R"}}];
        const files = (run) => ({laser: run.file, gyro: run.file, cameras: run.file});
        state.campaign.run = state.campaign.run.map((run) => ({...run, files: files(run)}));
        workbench.show(state);
    }""")
    placed = page.locator("#forms input[aria-label$=' sits']")
    assert placed.evaluate_all("all => all.map(e => e.getAttribute('aria-label'))") == [
        "where laser sits",
        "where cameras sits",
    ]
    assert "the middle of the rear axle" in placed.nth(1).locator("xpath=..").text_content()
    assert "Where laser sits was not given" in page.text_content("#assumed")


def test_another_law_makes_another_model(page: Any) -> None:
    take_in(page, *recordings())
    page.evaluate("for (const d of document.querySelectorAll('#forms details')) d.open = true")
    casters = page.locator("select[aria-label='law of the casters']")
    assert casters.input_value() == "ideal" and "each trails its pivot" in page.inner_text(".laws")
    casters.select_option("slipping")
    page.wait_for_function("() => workbench.state.laws.caster === 'slipping'")
    assert "shimmy" in page.inner_text(".laws") and "Caster law slipping" in page.inner_text("#history")
    page.click("#undo")
    page.wait_for_function("() => document.querySelector(\"select[aria-label='law of the casters']\").value === 'ideal'")


def test_sizes_that_no_chair_has_are_said_beside_their_fields(page: Any, tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    lab.rim(tmp_path / "run01_SWL.csv", lab.rides(1)[0], 0.7, "l", rng)
    take_in(page, tmp_path / "run01_SWL.csv")
    for words, size in {
        "mass of chair and rider": "-95,5",
        "radius of": "30.7",
        "A rear axle": "0.4",
        "B centre": "0.5",
    }.items():
        typed(page.locator("#lab label", has_text=words).locator("input"), size)
    page.click("#import")
    said = page.locator("#lab .wrong").all_inner_texts()
    assert "Give 10 to 400 kg." in said and "Give 0.05 to 1 m; is it 0.307 m?" in said
    assert page.evaluate("workbench.state.job") is None
    typed(page.locator("#lab [name=mass]"), "95,5 kg")
    typed(page.locator("#lab [name=radius]"), "30,7 cm")
    page.click("#import")
    assert "cannot be ahead of the casters" in page.inner_text("#lab")
    typed(page.locator("#lab [name=cm_ahead]"), "0,1")
    page.click("#import")
    done(page, "import")
    assert page.evaluate("[workbench.state.campaign.chair.m, workbench.state.campaign.wheel.R]") == [95.5, 0.307]


def test_an_effect_of_ones_own_is_judged_as_it_is_typed(page: Any) -> None:
    page.wait_for_function("() => window.workbench?.state")
    page.fill("#own [name=expression]", "q * (u + m)")
    page.wait_for_selector("#unit[data-state=bad]")
    known = "[...document.querySelectorAll('#words code')].map((e) => e.textContent)"
    assert {"F_w", "u", "a_x"} < set(page.evaluate(known)) and "F_y" not in page.evaluate(known)  # of F_x
    page.select_option("#own [name=to]", "delta")
    assert "u" in page.evaluate(known) and "F_xf" not in page.evaluate(known)
    page.select_option("#own [name=to]", "F_x")
    page.fill("#own [name=expression]", "-q * u")
    page.wait_for_selector("#unit[data-state=good]")
    assert "N s/m" in page.inner_text("#unit")
    page.fill("#own [name=id]", "rubbing_brake")
    page.fill("#own [name=title]", "a brake that rubs")
    page.click("#own button[type=submit]")
    page.wait_for_function("() => document.getElementById('effect').value === 'rubbing_brake'")


@pytest.mark.parametrize(("scheme", "width"), LOOKS)
def test_it_fits_and_shuts_nobody_out(
    page: Any, work: Path, report_file: Path, tmp_path: Path, width: int, scheme: str
) -> None:
    """With recordings in, a diagnosis beside the button and all open: nothing sticks out sideways, everything has a name, text
    stands out, and axe has nothing to say by WCAG 2.2 AA."""
    axe = pytest.importorskip("axe_playwright_python.sync_playwright", reason="axe is not installed: make test-browser does")
    bad = tmp_path / "bad.csv"
    bad.write_text("time [s],F_rl [N],F_rr [N],yaw_rate [furlong]\n0,1,2,3\n0,1,two,3\n")
    page.emulate_media(color_scheme=scheme)
    page.set_viewport_size({"width": width, "height": 844})
    take_in(page, *recordings(), bad)
    session = work / page.url.rpartition("/")[2]
    (session / "diagnosis.json").write_bytes(DIAGNOSIS.read_bytes())
    (session / "report.html").write_bytes(report_file.read_bytes())
    page.reload()
    page.wait_for_selector("#outcome .card")
    page.evaluate("for (const d of document.querySelectorAll('details')) d.open = true")
    page.evaluate("""workbench.poll = () => null, workbench.showJob({kind: "diagnose", state: "running", seconds: 9, steps: 4,
        lines: ["calibrating", "refitting camber_misalignment"], commands: [], usual: null, result: null})""")
    said = page.inner_text("#progress")
    assert re.fullmatch(r"Refitting with rear .* · step 4 of about \d+ · 9 s so far · about \d+ s left", said), said
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    unnamed = page.evaluate("""[...document.querySelectorAll('button, input, select, a')].filter(e =>
        !(e.innerText?.trim() || e.getAttribute('aria-label') || e.labels?.length)).map(e => e.outerHTML)""")
    assert not unnamed
    contrast = page.evaluate(Path(__file__).with_name("contrast.js").read_text())
    assert min(contrast.values()) >= 4.5, contrast
    found = axe.Axe().run(page).response["violations"]
    said = [(v["id"], v["impact"], v["nodes"][0]["html"][:160]) for v in found]
    assert not [s for s in said if s[1] in ("critical", "serious", "moderate")], said
