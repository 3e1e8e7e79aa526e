"""Chromium, and every night Firefox, where they and Playwright are there; the report of the sample campaign, written by the
command."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import zlib
from base64 import b64decode
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from benchmarks.page_open import OPTIONS
from tests.kit import SAMPLE_DIAGNOSIS as DIAGNOSIS
from tests.kit import shared
from wheelchair_fmu.cli.main import app

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "examples" / "sample-campaign"
LOOKS = [  # schemes and widths; two show each of both
    ("light", 1280),
    ("dark", 390),
    pytest.param("dark", 1280, marks=pytest.mark.nightly),
    pytest.param("light", 390, marks=pytest.mark.nightly),
]
PATIENCE = 60_000  # ms; what takes long on a busy machine is no fault


PROGRAMS = {"chromium": ("chromium", "google-chrome"), "firefox": ("firefox-esr", "firefox")}
CHROMIUM = pytest.mark.parametrize("browser", ["chromium"], indirect=True)  # for what the protocol of Firefox cannot do
CATCH = """() => {
    window.handed = null;
    if (window.made) return;
    window.made = new Map();
    const make = URL.createObjectURL;
    URL.createObjectURL = (blob) => { const url = make.call(URL, blob); made.set(url, blob); return url; };
    HTMLAnchorElement.prototype.click = function () { handed = { name: this.download, url: this.href }; };
}"""
CAUGHT = """async () => {
    const told = (url) => [handed.name, url.slice(url.indexOf(",") + 1)], reader = new FileReader();
    if (handed.url.startsWith("data:")) return told(handed.url);
    const read = new Promise((done) => { reader.onload = () => done(told(reader.result)); });
    reader.readAsDataURL(made.get(handed.url));
    return read;
}"""


@pytest.fixture(scope="session")
def driver() -> Iterator[Any]:
    playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed: make test-browser does")
    with playwright.sync_playwright() as running:
        yield running


@pytest.fixture(scope="session", params=["chromium", pytest.param("firefox", marks=pytest.mark.nightly)])
def browser(request: Any, driver: Any) -> Iterator[Any]:
    opened = launched(driver, request.param)
    yield opened
    opened.close()


def launched(driver: Any, name: str) -> Any:
    """A browser as the system has it."""
    program = next(filter(None, map(shutil.which, PROGRAMS[name])), None)
    if program is None:
        pytest.skip(f"no {name.capitalize()}: apt-get install {PROGRAMS[name][0]}")
    if name == "firefox":
        return driver.firefox.launch(channel="moz-firefox", executable_path=program)
    return driver.chromium.launch(executable_path=program, args=OPTIONS)


def handed_out(page: Any, act: Callable[[], object]) -> tuple[str, bytes]:
    """Name and content of the file that a page hands out after an act, as its scripts make it: not every browser's protocol
    tells of downloads."""
    page.evaluate(CATCH)
    act()
    page.wait_for_function("() => window.handed")
    name, content = page.evaluate(CAUGHT)
    return name, b64decode(content)


def pages_of(printed: bytes) -> int:
    """How many pages a PDF has, whether or not its objects are packed."""
    packed = re.findall(rb"/ObjStm.*?stream\r?\n(.*?)\s*endstream", printed, re.DOTALL)
    objects = [printed, *(zlib.decompressobj().decompress(stream) for stream in packed)]
    return sum(len(re.findall(rb"/Type\s*/Page\b", one)) for one in objects)


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the workbench keeps its work."""
    return tmp_path_factory.mktemp("work")


@pytest.fixture(scope="module")
def address(work: Path) -> Iterator[str]:
    """A workbench that runs, with its token, which a browser keeps as a cookie."""
    pytest.importorskip("uvicorn", reason="the workbench's libraries are not installed")
    words = [sys.executable, "-m", "wheelchair_fmu", "workbench", "--port", "0", "--no-open", "--folder", str(work)]
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True, env=env, cwd=work) as server:
        assert server.stdout
        yield server.stdout.readline().split()[0]
        server.terminate()


@pytest.fixture(scope="session")
def report_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shared(tmp_path_factory, "report", lambda folder: report_of(SAMPLE, folder / "report.html")) / "report.html"


def report_of(campaign: Path, file: Path, diagnosis: Path = DIAGNOSIS) -> Path:
    """The report of the sample campaign, or of one like it."""
    done = CliRunner().invoke(app, ["report", str(campaign), "--diagnosis", str(diagnosis), "-o", str(file)])
    assert done.exit_code == 0, done.output
    return file


class Reader:
    """Somebody with the report open, from disk, with the network off; every complaint of the page is kept."""

    def __init__(self, browser: Any, file: Path, width: int = 1280, scheme: str = "light", end: str = ""):
        self.context = browser.new_context(viewport={"width": width, "height": 900}, color_scheme=scheme, offline=True)
        self.page = self.context.new_page()
        self.page.set_default_timeout(PATIENCE)
        self.complaints: list[str] = []
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", self._listen)
        self.page.on("request", lambda r: r.url.startswith("http") and self.complaints.append(f"asked for {r.url}"))
        self.page.goto(file.as_uri() + end)
        self.settle()

    def _listen(self, message: Any) -> None:
        if message.type in ("error", "warning", "trace"):
            self.complaints.append(message.text)

    def settle(self) -> None:
        """Until the numbers are exact and nothing more is coming."""
        self.page.wait_for_function(
            "() => window.report && !report.running && !report.pending && !report.fitting && report.settled && "
            "document.getElementById('status').dataset.state === 'exact'"
        )

    def set(self, values: dict[str, float]) -> None:
        self.page.evaluate("values => report.controls.put(values)", values)
        self.settle()

    def table(self) -> dict[str, dict[str, float]]:
        """Whitened RMS by run and channel."""
        return self.page.evaluate("""() => Object.fromEntries(report.campaign.runs.map((run, i) => {
            const {squares, counts} = report.results[i];
            return [run.name, Object.fromEntries(Object.keys(squares).map(c => [c, Math.sqrt(squares[c] / counts[c])]))];
        }))""")  # type: ignore[no-any-return]

    def close(self) -> None:
        self.context.close()
        assert not self.complaints


@pytest.fixture
def reader(browser: Any, report_file: Path) -> Iterator[Reader]:
    opened = Reader(browser, report_file)
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def open_report(browser: Any, report_file: Path) -> Iterator[Reader]:
    """For who changes nothing but values, all of them, or nothing."""
    opened = Reader(browser, report_file)
    yield opened
    opened.close()
