"""Cards and screens of the story as HTML, there before any script runs and without any."""

from __future__ import annotations

import re
from collections.abc import Container, Mapping, Sequence
from html import escape
from typing import Any

from .words import capital

COMMAND = re.compile(r"(wheelchair (?:add|improve) [\w .-]+?)\.$")  # at the end of a sentence, as somebody types it
KEPT = re.compile(r"(?<=\d) (?=[%±])|(?<=±) ")
SYMBOL = re.compile(r"\b([^\W\d_])_([^\W_]+)\b")  # one letter with an index: C_λ


def cards_html(cards: Sequence[Mapping[str, Any]]) -> str:
    """Three cards above the fold."""
    return "".join(
        f'<section class="card"><h2>{escape(c["head"])}</h2><p class="lead">{marked(c["lead"])}</p>'
        f"{_gauge(c['gauge']) if 'gauge' in c else ''}{_lines(c['lines'])}</section>"
        for c in cards
    )


def _gauge(gauge: Mapping[str, Any]) -> str:
    """Bars beside a mark; the sentences say the same."""
    longest = 1.1 * max(gauge["mark"], *(length for _, length in gauge["bars"]))
    at = f"left:{100 * gauge['mark'] / longest:.1f}%"
    bars = "".join(
        f'<span>{escape(label)}</span><b><i style="width:{100 * length / longest:.1f}%"></i><u style="{at}"></u></b>'
        for label, length in gauge["bars"]
    )
    mark = f'<span></span><b class="mark"><em style="{at}">{escape(gauge["words"])}</em></b>'
    return f'<div class="gauge" aria-hidden="true">{bars}{mark}</div>'


def screens_html(screens: Sequence[Mapping[str, Any]], live: Container[str] = ()) -> str:
    """Five screens, one under the other until a script shows them one by one. Lines that are `live` are shown only where the
    model runs."""
    return "".join(
        f'<section class="screen" data-kind="{escape(s["kind"])}" aria-labelledby="screen-{i}">'
        f'<h3 id="screen-{i}" tabindex="-1"><span>{i}</span> {escape(s["title"])}</h3>'
        f'<div class="told">{_lines(s["lines"], live)}</div><div class="stage">{_choices(s)}</div></section>'
        for i, s in enumerate(screens, 1)
    )


def _choices(screen: Mapping[str, Any]) -> str:
    """What may be guessed, as a list that stands until a script makes buttons of it."""
    titles = "".join(f"<li>{escape(capital(choice['title']))}</li>" for choice in screen.get("choices", ()))
    return f'<ul class="guesses">{titles}</ul>' if titles else ""


def _lines(lines: Sequence[str], live: Container[str] = ()) -> str:
    kinds = ((' class="live"' if line in live else "", marked(line)) for line in lines)
    return "".join(f"<p{kind}>{words}</p>" for kind, words in kinds)


def marked(line: str) -> str:
    """A sentence as HTML, with commands and symbols as they are printed; a number stays with its per cent and its error."""
    together = KEPT.sub("\N{NO-BREAK SPACE}", escape(line))
    return SYMBOL.sub(r"\1<sub>\2</sub>", COMMAND.sub(_typed, together))


def _typed(command: re.Match[str]) -> str:
    return f"<code>{command[1]}</code>"
