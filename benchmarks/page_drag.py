"""What the report's page costs while somebody drags a slider:  python -m benchmarks.page_drag [REPORT.html]

In headless Chromium, by Playwright (`make test-browser` installs it): how soon the numbers are exact after opening, frames a
second while a size is dragged, and of the main thread what each update costs, all of it by Chromium's own count, and what of it
is this page's drawing. Without a report it writes one of the sample campaign.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from statistics import median
from typing import Any

from .page_open import EXACT, opened

ROUNDS, MOVES, EVERY = 7, 30, 16  # movements of the pointer in each of some rounds, and ms between two
FRAMES = """() => {
    window.frames_at = [];
    const frame = (now) => { frames_at.push(now); requestAnimationFrame(frame); };
    requestAnimationFrame(frame);
    report.costs.length = report.timings.length = 0;
}"""


def measured(page: Any) -> dict[str, float]:
    """Milliseconds, and frames a second, by what they are of."""
    exact = page.evaluate("report.exactAt")
    effect = page.evaluate("report.campaign.diagnosis.effects[0]")
    page.check(f"#effect-{effect}")
    page.wait_for_timeout(500)
    page.wait_for_function(EXACT)
    slider = page.locator(f'[id^="slider-effect.{effect}."]').first
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + 0.7 * box["width"], middle)
    page.mouse.down()
    page.evaluate(FRAMES)
    counts = page.context.new_cdp_session(page)
    counts.send("Performance.enable", {"timeDomain": "threadTicks"})
    rounds = [_dragged(page, counts, box, middle, k) for k in range(ROUNDS)]
    told = page.evaluate("""({frames: frames_at, costs: report.costs.filter(c => !c.rested).map(c => c.ms),
        all: report.timings.map(t => t.all), one: report.timings.map(t => t.one)})""")
    page.mouse.up()
    gaps = sorted(b - a for a, b in zip(told["frames"], told["frames"][1:], strict=False))
    return {
        "exact numbers after opening [ms]": exact,
        "frames a second while dragging": 1000 * len(gaps) / sum(gaps),
        "95 % of frames within [ms]": gaps[int(0.95 * len(gaps))],
        "updates a second": 1000 * len(told["all"]) / sum(gaps),
        "from a movement to its run [ms]": median(told["one"]),
        "from a movement to all runs [ms]": median(told["all"]),
        **{f"main thread an update, {name} [ms]": median(r[name] for r in rounds) for name in rounds[0]},
        "drawing an update, by the clock [ms]": median(told["costs"]),
    }


def _dragged(page: Any, counts: Any, box: dict[str, float], middle: float, k: int) -> dict[str, float]:
    """What an update costs of the main thread, over some updates: its own time, whatever else runs beside it."""
    before, updates = _counted(counts), page.evaluate("report.timings.length")
    for i in range(MOVES):
        part = i / MOVES if k % 2 else 1 - i / MOVES
        page.mouse.move(box["x"] + (0.3 + 0.4 * part) * box["width"], middle)
        page.wait_for_timeout(EVERY)
    after, updates = _counted(counts), page.evaluate("report.timings.length") - updates
    spent = {key: 1000 * (after[key] - before[key]) / max(1, updates) for key in after}
    laid = spent["LayoutDuration"] + spent["RecalcStyleDuration"]
    return {"all of it": spent["TaskDuration"], "scripts": spent["ScriptDuration"], "layout and styles": laid}


def _counted(counts: Any) -> dict[str, float]:
    return {m["name"]: m["value"] for m in counts.send("Performance.getMetrics")["metrics"]}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("report", type=Path, nargs="?")
    with opened(parser.parse_args().report) as page:
        for name, value in measured(page).items():
            print(f"{name}: {value:.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
