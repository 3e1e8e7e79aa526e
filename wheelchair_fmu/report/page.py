"""One HTML file that carries the page, its data and the model: nothing is fetched when it is read."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping, Sequence
from html import escape
from importlib.resources import files
from typing import Any

ASSETS = files(__package__) / "page"
MODULES = ("app", "charts", "controls", "dom", "errors", "evidence", "figure", "numbers", "pool", "trajectory")
POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' data: blob:; style-src 'unsafe-inline'; "
    "img-src data: blob:; worker-src blob:"
)


def page(content: Mapping[str, Any], sentence: str, particulars: Sequence[str]) -> str:
    """The page as HTML, from what `content.content` gives; `sentence` and `particulars` are there before any script runs."""
    places = {
        "title": f"{escape(content['name'])}: {escape(sentence)}",
        "name": escape(content["name"]),
        "sentence": escape(sentence),
        "particulars": "".join(f"<p>{escape(line)}</p>" for line in particulars),
        "policy": POLICY,
        "style": asset("style.css"),
        "method": asset("method.html"),
        "worker": _in_script(asset("worker.js")),
        "importmap": json.dumps({"imports": {f"page/{m}": _data_url(asset(f"{m}.js")) for m in MODULES}}),
        "plotly": _in_script(asset("vendor/plotly-basic.min.js")),
        "content": json.dumps(content, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c"),
    }
    head, *rest = asset("page.html").split("{{")
    parts = [head]
    for piece in rest:  # one pass, so that nothing in the data is taken for a place
        name, _, text = piece.partition("}}")
        parts += [places[name], text]
    return "".join(parts)


def asset(name: str) -> str:
    """The text of a file of the page."""
    return ASSETS.joinpath(name).read_text(encoding="utf-8")


def _data_url(text: str) -> str:
    return f"data:text/javascript;base64,{b64encode(text.encode()).decode()}"


def _in_script(text: str) -> str:
    """JavaScript that may stand in a <script>."""
    return text.replace("</script", "<\\/script")
