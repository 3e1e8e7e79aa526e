"""One HTML file that carries the page, its data and the model: nothing is fetched when it is read."""

from __future__ import annotations

import json
import zlib
from base64 import b64decode, b64encode
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from typing import Any

from .markup import cards_html, marked, screens_html
from .press import press
from .screens import LIVE
from .tale import Story

ASSETS = files(__package__) / "page"
MODULES = (
    "address",
    "app",
    "controls",
    "dom",
    "draw",
    "errors",
    "evidence",
    "figure",
    "figures",
    "forest",
    "heat",
    "following",
    "landscape",
    "lines",
    "mini",
    "motion",
    "numbers",
    "paper",
    "pen",
    "pins",
    "pool",
    "publish",
    "refit",
    "regimes",
    "scene",
    "staircase",
    "story",
    "timeline",
    "words",
)
PLOT = "vendor/uplot-1.6.32"  # https://github.com/leeoniya/uPlot, MIT
KEPT = 12  # characters of a fingerprint that are enough to tell it
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' data: blob:; style-src 'unsafe-inline'; "
    "img-src data: blob:; worker-src blob:"
)


def page(content: Mapping[str, Any], sentence: str, particulars: Sequence[str], story: Story) -> str:
    """The page as HTML, from what `content.content` gives; `sentence`, `particulars` and `story` are there before any script
    runs."""
    carried = {**content, "story": {"screens": story.screens, "physical": story.physical, "following": story.following}}
    words = json.dumps(carried, ensure_ascii=False)
    places = {
        "title": f"{escape(content['name'])}: {escape(sentence)}",
        "name": escape(content["name"]),
        "sentence": escape(sentence),
        "particulars": "".join(f"<p>{marked(line)}</p>" for line in (*particulars, *story.physical)),
        "cards": cards_html(story.cards),
        "screens": screens_html(story.screens, LIVE),
        "made": escape(_made(content.get("diagnosis") or {})),
        "policy": POLICY,
        "style": asset("style.css"),
        "plotstyle": asset(f"{PLOT}.min.css"),
        "method": asset("method.html"),
        "worker": _in_script(asset("worker.js")),
        "importmap": json.dumps({"imports": {f"page/{m}": _data_url(asset(f"{m}.js")) for m in MODULES}}),
        "plot": _in_script(f"/*\n{asset('vendor/uplot-LICENSE.txt')}*/\n{asset(f'{PLOT}.iife.min.js')}"),
        "press": packed(press([words, words.upper(), *(asset(f"{m}.js") for m in MODULES)])),
        "content": packed(carried),
    }
    head, *rest = asset("page.html").split("{{")
    parts = [head]
    for piece in rest:  # one pass, so that nothing in the data is taken for a place
        name, _, text = piece.partition("}}")
        parts += [places[name], text]
    return "".join(parts)


def _made(diagnosis: Mapping[str, Any]) -> str:
    """Which program found this in which measurements, so that a printed page can be traced."""
    made, data = diagnosis.get("made_by") or {}, diagnosis.get("fingerprint")
    version = " ".join(part for part in ("wheelchair-fmu", made.get("version")) if part)
    code = f" (code {made['code'][:KEPT]})" if made.get("code") else ""
    return f"Found by {version}{code}{f' in measurements with the fingerprint {data[:KEPT]}' if data else ''}."


def packed(content: Mapping[str, Any]) -> str:
    """JSON, deflated, in base64: measurements and models are most of the page."""
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return b64encode(zlib.compress(text.encode(), 9)).decode()


def unpacked(html: str) -> dict[str, Any]:
    """The content of a page."""
    stored = html.partition('id="content">')[2].partition("</script>")[0]
    content: dict[str, Any] = json.loads(zlib.decompress(b64decode(stored)))
    return content


def asset(name: str) -> str:
    """The text of a file of the page."""
    return ASSETS.joinpath(name).read_text(encoding="utf-8")


def _data_url(text: str) -> str:
    return f"data:text/javascript;base64,{b64encode(text.encode()).decode()}"


def _in_script(text: str) -> str:
    """JavaScript that may stand in a <script>."""
    return text.replace("</script", "<\\/script")
