"""The workbench in a real browser: from an empty start to an exported FMU that fmpy runs."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import fmpy
import pytest

from tests.browser.conftest import PATIENCE, ROOT, SAMPLE

pytest.importorskip("uvicorn", reason="the workbench's libraries are not installed")
RUNS = ("coast-down", "random-steps", "slalom-quick", "holdout-random")  # which show the effect, and are soon diagnosed
LONG = 300_000  # ms for a diagnosis, models compiled for the first time, on a busy machine


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("work")
    words = [sys.executable, "-m", "wheelchair_fmu.cli.main", "workbench", "--port", "0", "--no-open", "--folder", str(folder)]
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=env, cwd=folder) as server:
        assert server.stdout
        yield server.stdout.readline().split()[0]  # with its token, which the browser keeps as a cookie
        server.terminate()


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
    page.wait_for_function("() => document.getElementById('job').innerText.includes('calibrating')", timeout=LONG)  # live
    page.reload()  # and nothing is lost
    done(page, "diagnose")
    report = page.frame_locator("#report")
    assert "rolls harder" in report.locator("h1").inner_text()
    report.locator("#effect-rolling_resistance_asymmetry").check()
    report.locator("#status[data-state=exact]").wait_for()
    page.select_option("#effect", "rolling_resistance_asymmetry")
    page.click("#add")
    done(page, "add")
    assert "held out:" in page.inner_text("#history li[aria-current]")
    page.wait_for_selector("#old-report:visible")  # the report does not know the effect yet
    with page.expect_download() as waiting:
        page.click("#export-fmu")
    file = tmp_path / "Better.fmu"
    waiting.value.save_as(file)
    starts = {v.name: v.start for v in fmpy.read_model_description(str(file)).modelVariables}
    assert float(starts["effect.rolling_resistance_asymmetry.D"]) == pytest.approx(1.6, abs=0.15)
    result = fmpy.simulate_fmu(str(file), stop_time=1.0, output=["chair.psi"])
    assert result["chair.psi"][-1] < 0  # the left wheel drags, so the chair turns left
    with page.expect_download() as waiting:
        page.click("#export-ssv")
    assert b'name="effect.rolling_resistance_asymmetry.D"' in Path(waiting.value.path()).read_bytes()
    page.click("#undo")
    page.wait_for_function("() => workbench.state.history.at === 0")
    assert page.inner_text("#history li[aria-current]") == "nominal"
    page.click("#redo")
    page.wait_for_function("() => workbench.state.history.at === 1")


def test_bad_files_show_their_faults_in_the_page(page: Any, tmp_path: Path) -> None:
    bad = tmp_path / "bad.csv"
    bad.write_text("time [s],F_rl [N],F_rr [N],yaw_rate [furlong]\n0,1,2,3\n0,1,two,3\n")
    take_in(page, bad)
    faults = page.inner_text("#faults")
    assert "faults to mend" in faults
    assert "unit 'furlong' measures a length" in faults
    assert "'two' is not a number" in faults
    assert page.is_disabled("#diagnose")
    page.fill('[aria-label="unit of yaw_rate [furlong]"]', "deg/s")
    page.press('[aria-label="unit of yaw_rate [furlong]"]', "Tab")
    page.wait_for_function("() => !document.getElementById('faults').innerText.includes('measures a length')")


def test_cancelling_leaves_things_as_they_were(page: Any) -> None:
    take_in(page, *recordings())
    page.click("#diagnose")
    page.wait_for_function("() => document.getElementById('job').innerText.includes('calibrating')", timeout=LONG)
    page.click("#cancel")
    page.wait_for_function("() => workbench.state.job?.state === 'cancelled'")
    assert page.is_enabled("#diagnose")
    assert page.is_hidden("#report")


def test_two_tabs_are_two_pieces_of_work(page: Any, address: str) -> None:
    take_in(page, *recordings())
    other = page.context.new_page()
    other.goto(address)
    other.wait_for_function("() => window.workbench?.state")
    assert other.url != page.url
    assert other.evaluate("workbench.state.files") == []
    assert other.locator("#earlier a").count() >= 1


def test_noise_and_priors_are_a_form_whose_changes_can_be_undone(page: Any) -> None:
    take_in(page, *recordings())
    page.click("text=Noise of the sensors")
    field = page.locator("label", has_text="yaw_rate").locator("input").last
    assert "rad/s" in field.get_attribute("placeholder")
    field.fill("0.5 deg/s")
    field.press("Tab")
    page.wait_for_function("() => workbench.state.campaign.noise?.yaw_rate === '0.5 deg/s'")
    page.click("text=How sure these values are")
    prior = page.locator('input[aria-label^="prior of chair.I_z:"]')
    prior.fill("0.2")
    prior.press("Tab")
    page.wait_for_function("() => workbench.state.campaign.prior?.chair?.I_z === 0.2")
    assert "prior.chair.I z = 0.2" in page.inner_text("#history li[aria-current]")
    page.click("#undo")
    page.wait_for_function("() => workbench.state.campaign.prior?.chair?.I_z === undefined")
    assert page.evaluate("workbench.state.campaign.noise.yaw_rate") == "0.5 deg/s"
    page.click("#undo")
    page.wait_for_function("() => !workbench.state.campaign.noise")


def test_an_effect_of_ones_own_is_judged_as_it_is_typed(page: Any) -> None:
    page.wait_for_function("() => window.workbench?.state")
    page.fill("#own [name=expression]", "q * (u + m)")
    page.wait_for_selector("#unit[data-state=bad]")
    page.fill("#own [name=expression]", "-q * u")
    page.wait_for_selector("#unit[data-state=good]")
    assert "N s/m" in page.inner_text("#unit")
    page.fill("#own [name=id]", "rubbing_brake")
    page.fill("#own [name=title]", "a brake that rubs")
    page.click("#own button[type=submit]")
    page.wait_for_function("() => document.getElementById('effect').value === 'rubbing_brake'")


@pytest.mark.parametrize("width", [1280, 390])
def test_it_fits(page: Any, width: int) -> None:
    page.set_viewport_size({"width": width, "height": 844})
    take_in(page, *recordings())
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    unnamed = page.evaluate("""[...document.querySelectorAll('button, input, select, a')].filter(e =>
        !(e.innerText?.trim() || e.getAttribute('aria-label') || e.labels?.length)).map(e => e.outerHTML)""")
    assert not unnamed
