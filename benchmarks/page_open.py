"""A report of the sample campaign, or one that is given, open in headless Chromium (`make test-browser` has Playwright)."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .loop_cost import SAMPLE

DIAGNOSIS = Path("tests/sample-diagnosis.json")
OPTIONS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
EXACT = "() => window.report?.settled && document.getElementById('status').dataset.state === 'exact'"
ASIDE = 3000  # ms in which what is simulated aside comes to its end


@contextmanager
def opened(report: Path | None = None) -> Iterator[Any]:
    """The page, once its numbers are exact."""
    from playwright.sync_api import sync_playwright

    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    with tempfile.TemporaryDirectory() as place, sync_playwright() as running:
        file = report or Path(place) / "report.html"
        if not report:
            words = [sys.executable, "-m", "wheelchair_fmu", "report", str(SAMPLE), "--diagnosis", str(DIAGNOSIS)]
            subprocess.run([*words, "-o", str(file)], check=True, stdout=subprocess.DEVNULL)
        browser = running.chromium.launch(executable_path=chromium, args=OPTIONS)
        page = browser.new_page(viewport={"width": 1280, "height": 900}, color_scheme="light")
        page.goto(file.resolve().as_uri())
        page.wait_for_function(EXACT)
        page.wait_for_timeout(ASIDE)
        yield page
        browser.close()
