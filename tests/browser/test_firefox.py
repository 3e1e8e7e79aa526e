"""Both pages in Firefox: what they show, and that it is what Chromium shows."""

from __future__ import annotations

import json
import re
import shutil
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.browser.conftest import DIAGNOSIS, Reader

pytest.importorskip("websockets", reason="websockets is not installed: make test-browser does")
from tests.browser.firefox import Page, firefox

pytestmark = pytest.mark.nightly
TOLD = json.loads(DIAGNOSIS.read_text())
HIDDEN = "rolling_resistance_asymmetry"
SETTLED = "window.report?.settled && !report.running && !report.fitting"
DARK = """(() => {
    const canvas = new OffscreenCanvas(picture.width, picture.height), context = canvas.getContext('2d');
    context.drawImage(picture, 0, 0);
    const {data} = context.getImageData(0, 0, picture.width, picture.height);
    let dark = 0;
    for (let i = 0; i < data.length; i += 4) dark += data[i] + data[i + 1] + data[i + 2] < 300;
    return {width: picture.width, corner: [...data.slice(0, 3)], share: dark / (data.length / 4)};
})()"""
TABLE = """report.results.map(({squares, counts}) => Object.fromEntries(
    Object.keys(squares).map(c => [c, Math.sqrt(squares[c] / counts[c])])))"""


@pytest.fixture(scope="module")
def opened(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    program = shutil.which("firefox-esr") or shutil.which("firefox")
    if program is None:
        pytest.skip("no Firefox: apt-get install firefox-esr")
    with firefox(program, tmp_path_factory.mktemp("profile")) as socket:
        yield socket


@pytest.fixture
def page(opened: Any, report_file: Path) -> Iterator[Page]:
    shown = Page(opened, 1280, 900)
    shown.goto(report_file.as_uri())
    shown.wait(SETTLED)
    yield shown
    shown.close()


def test_the_report_opens_with_the_numbers_of_the_diagnosis(page: Page) -> None:
    step = TOLD["ladder"][1]
    assert page.evaluate("report.now") == pytest.approx({k: step[k] for k in ("fit", "heldout")}, abs=0.01)
    assert page.evaluate("document.querySelectorAll('.card').length") == 3
    assert page.evaluate("report.timeline.plots.length") == 2
    assert page.evaluate("document.documentElement.scrollWidth") <= 1280


def test_a_tick_lowers_the_error(page: Page) -> None:
    page.evaluate(f"document.getElementById('effect-{HIDDEN}').click()")
    page.wait(f"report.now.heldout < 1.05 && {SETTLED}")
    assert page.evaluate("report.now.heldout") == pytest.approx(TOLD["ladder"][-1]["heldout"], abs=0.01)
    assert page.evaluate("document.getElementById('now-heldout').innerText") == f"{TOLD['ladder'][-1]['heldout']:.2f}"


def test_its_figures_are_those_of_chromium(page: Page, browser: Any, report_file: Path) -> None:
    chromium = Reader(browser, report_file)
    values = {**TOLD["models"][-1]["values"], "tyre.C_lambda": 4500.0, "effect.push_force_delay.tau": 0.013}
    chromium.set(values)
    page.evaluate(f"report.controls.put({json.dumps(values)})")
    page.wait(SETTLED)
    for here, there in zip(page.evaluate(TABLE), chromium.page.evaluate(TABLE), strict=True):
        assert here == pytest.approx(there, rel=1e-9)
    edges = "report.band(report.results[report.shown.run], null).map(e => [...e])"
    assert page.evaluate("report.shown") == chromium.page.evaluate("report.shown")
    for here, there in zip(page.evaluate(edges), chromium.page.evaluate(edges), strict=True):
        assert here == pytest.approx(there, rel=1e-9, abs=1e-9)
    chromium.close()


def test_figures_are_handed_out_whole(page: Page) -> None:
    """What writes SVG, PNG and PDF runs here too, from the same drawings; a picture has ink on white."""
    page.evaluate("globalThis.files = [], globalThis.made = URL.createObjectURL, 0")
    page.evaluate("URL.createObjectURL = (blob) => (files.push(blob), made.call(URL, blob)), 0")
    for figure in ("staircase", "overlay", "joint"):
        for label, kind in (("PDF 85 mm", "application/pdf"), ("PNG 85 mm", "image/png"), ("SVG 170 mm", "image/svg+xml")):
            page.evaluate("files.length = 0, 0")
            button = f"[...document.querySelectorAll('#{figure} .menu button')].find(b => b.textContent === '{label}')"
            page.evaluate(f"{button}.click()")
            page.wait(f"files.some(b => b.type === '{kind}')")
            start = page.evaluate(f"files.find(b => b.type === '{kind}').slice(0, 5).text()")
            assert start.startswith({"PDF 85 mm": "%PDF-", "PNG 85 mm": "\ufffdPNG", "SVG 170 mm": "<?xml"}[label]), figure
            if kind == "image/png":
                page.evaluate(
                    "createImageBitmap(files.find(b => b.type === 'image/png')).then(p => { globalThis.picture = p; })"
                )
                dark = page.evaluate(DARK)
                assert dark["width"] == round(85 / 25.4 * 400) and min(dark["corner"]) > 250 and dark["share"] > 0.005


def test_print_is_two_pages(page: Page) -> None:
    """Cairo packs its objects: they are read where they unpack."""
    streams = re.findall(rb"/ObjStm.*?stream\r?\n(.*?)\s*endstream", page.printed(), re.DOTALL)
    objects = b"".join(zlib.decompressobj().decompress(stream) for stream in streams)
    assert len(re.findall(rb"/Type\s*/Page\b", objects)) == 2


def test_arrow_keys_and_undo(page: Page) -> None:
    """What a person without a pointer uses: a box by its label's click, a slider by its keys, undoing."""
    page.evaluate(f"document.getElementById('effect-{HIDDEN}').click()")
    page.wait(f"report.now.heldout < 1.05 && {SETTLED}")
    size = f"report.values['effect.{HIDDEN}.D']"
    before = page.evaluate(size)
    slider = f"document.getElementById('slider-effect.{HIDDEN}.D')"
    page.evaluate(
        f"{slider}.focus(), {slider}.dispatchEvent(new KeyboardEvent('keydown', {{key: 'ArrowRight', cancelable: true}})), 0"
    )
    page.wait(SETTLED)
    assert page.evaluate(size) > before
    page.evaluate("document.getElementById('undo').click()")
    page.wait(f"{SETTLED} && {size} === {before}")


def test_the_workbench_opens_and_takes_in_the_sample(opened: Any, address: str) -> None:
    page = Page(opened, 1280, 900)
    page.goto(address)
    page.wait("window.workbench?.state")
    page.evaluate("document.getElementById('sample').click()")
    page.wait("workbench.state.files.length === 10")
    assert page.evaluate("document.querySelector('#faults b').innerText") == "These recordings can be read."
    assert not page.evaluate("document.getElementById('diagnose').disabled")
    page.close()
