"""The picture of the report in README.md:  python -m benchmarks.page_picture [docs/report.png]

The sample campaign's report with the effect put in, down to the chair and its curves.
"""

from __future__ import annotations

import sys

from .page_open import EXACT, opened

MOMENT = 1.7  # s, in a stroke


def main() -> int:
    target = sys.argv[1] if len(sys.argv) > 1 else "docs/report.png"
    with opened() as page:
        page.click(".tab >> nth=2")
        page.click(".screen:visible .big")
        page.wait_for_timeout(500)
        page.wait_for_function(EXACT)
        page.evaluate(f"report.timeline.go({MOMENT})")
        page.evaluate("document.activeElement.blur(), scrollTo(0, 0)")
        page.wait_for_timeout(500)
        end = page.evaluate("document.querySelector('.stage-pair').getBoundingClientRect().bottom")
        page.screenshot(path=target, full_page=True, clip={"x": 0, "y": 0, "width": 1280, "height": end})
    print(target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
