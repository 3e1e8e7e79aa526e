"""Every screen of reports at four widths in both themes:  python -m benchmarks.page_screens REPORT.html ... -o FOLDER

In headless Chromium, by Playwright (`make test-browser` installs it). Written are pictures of what stands above the fold, of
each of the five screens of the story and of the whole page, by report, width and theme; printed is what a program can see by
itself: what sticks out sideways, words of a drawing that are cut off or over one another, numbers that are none, code names
in prose, and whatever the page complains of.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .page_open import EXACT, OPTIONS

WIDTHS, THEMES = (390, 768, 1280, 1920), ("light", "dark")
HEIGHT = 900
PATIENCE = 240_000  # ms
PARTS = ("verdict", "try", "evidence", "ties")
OPEN = "(open) => { for (const d of document.querySelectorAll('#particulars, #controls details')) d.open = open; }"
SHOWN = "* { content-visibility: visible !important } .now, #controls { position: static !important }"  # all of a page at once
FAULTS = Path(__file__).with_name("page_screens.js").read_text(encoding="utf-8")


def main() -> int:
    from playwright.sync_api import sync_playwright

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("reports", nargs="+", type=Path)
    parser.add_argument("-o", "--out", type=Path, required=True)
    parser.add_argument("--widths", type=int, nargs="+", default=WIDTHS)
    parser.add_argument("--themes", nargs="+", default=THEMES)
    asked = parser.parse_args()
    wrong = 0
    with sync_playwright() as running:
        browser = running.chromium.launch(executable_path=shutil.which("chromium"), args=OPTIONS)
        for report in asked.reports:
            for width in asked.widths:
                for line in taken(browser, report, width, asked.themes, asked.out / report.stem):
                    wrong += 1
                    print(line, flush=True)
        browser.close()
    print(f"{wrong} faults that a program can see")
    return int(wrong > 0)


def taken(browser: Any, report: Path, width: int, themes: list[str], out: Path) -> Iterator[str]:
    """Pictures of a report at one width; yields what is wrong with it."""
    out.mkdir(parents=True, exist_ok=True)
    page = browser.new_page(viewport={"width": width, "height": HEIGHT}, color_scheme=themes[0])
    page.set_default_timeout(PATIENCE)
    said: list[str] = []
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("console", lambda m: m.type in ("error", "warning") and said.append(m.text))
    page.goto(report.resolve().as_uri())
    page.add_style_tag(content=SHOWN)
    page.wait_for_function(EXACT)
    page.wait_for_timeout(1500)
    page.wait_for_function(EXACT)
    for theme in themes:
        page.emulate_media(color_scheme=theme)
        page.wait_for_timeout(200)
        name = f"{width}-{theme}"
        page.evaluate("scrollTo(0, 0)")
        page.screenshot(path=out / f"{name}-0-top.png")
        for i in range(5):
            page.click(f".tab >> nth={i}")
            if i == 1:
                page.click(".choice >> nth=0")
                page.wait_for_timeout(500)
            if i == 2 and theme == themes[0]:
                page.click(".screen:visible .big")
                page.wait_for_timeout(300)
                page.wait_for_function(EXACT)
            page.wait_for_timeout(150)
            page.locator("#story").screenshot(path=out / f"{name}-{i + 1}.png")
            yield from (f"{report.stem} {name} screen {i + 1}: {fault}" for fault in page.evaluate(FAULTS))
        page.evaluate(OPEN, True)
        page.wait_for_timeout(300)
        for part in PARTS:
            page.locator(f"#{part}").screenshot(path=out / f"{name}-{part}.png")
        yield from (f"{report.stem} {name} all open: {fault}" for fault in page.evaluate(FAULTS))
        page.evaluate(OPEN, False)
    yield from (f"{report.stem} {width} says: {line}" for line in said)
    page.close()


if __name__ == "__main__":
    sys.exit(main())
