"""`wheelchair quantities`: what the equations speak of, for laws of one's own."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from rich import box
from rich.table import Table

from ..model.dimensions import targets, vocabulary
from ..model.wheelchair import Choice, assemble
from ..writing import written
from .files import print_json
from .group import console
from .terminal import announce

HEAD = """# The quantities

What a law of [an effect of your own](your-own-effect.md) may read, by its symbol, and what an effect may act on: parameters,
inputs, states, and what [the model's stages](physics.md) define, in their order. A pair has one component for each wheel of an
axle, the left one first. The page is written by `make docs`; `wheelchair quantities` prints the same.

| symbol | unit | of | may be acted on | what it is |
|---|---|---|---|---|
"""
LAWS = (("caster", "swivelling"), ("wheel", "spinning"))  # that bring quantities of their own, for effects that need them


def register(app: typer.Typer) -> None:
    app.command()(quantities)


def quantities(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    page: Annotated[Path | None, typer.Option(metavar="FILE", help="Write them as a page in Markdown instead.")] = None,
) -> None:
    """What a law of your own may read, by its symbol, and what an effect may act on."""
    told = records()
    if page:
        with written(page) as beside:
            beside.write_text(HEAD + "".join(f"| {' | '.join(_row(t, '`'))} |\n" for t in told), encoding="utf-8", newline="\n")
        announce(page)
    elif as_json:
        print_json(told)
    else:
        table = Table(box=box.SIMPLE)
        for title in ("symbol", "unit", "of", "may be acted on", "what it is"):
            table.add_column(title, no_wrap=title != "what it is")
        for t in told:
            table.add_row(*_row(t))
        console().print(table)


def records() -> list[dict[str, Any]]:
    """Each quantity as plain data."""
    usual = assemble(Choice())
    others = {law: assemble(Choice().with_laws({law[0]: law[1]})) for law in LAWS}
    needed = {symbol: {law[0]: law[1]} for law, model in others.items() for symbol in vocabulary(model)}
    needed |= {symbol: {} for symbol in vocabulary(usual)}
    acted_on = {symbol for model in (usual, *others.values()) for symbol in targets(model)}
    known = {symbol: q for model in (*others.values(), usual) for symbol, q in vocabulary(model).items()}
    return [
        {
            "symbol": symbol,
            "unit": q.unit.name,
            "components": ", ".join(q.components),
            "meaning": q.meaning,
            "acted_on": symbol in acted_on,
            "needs": needed[symbol],
        }
        for symbol, q in known.items()
    ]


def _row(told: dict[str, Any], mark: str = "") -> tuple[str, ...]:
    needs = "".join(f'; with {mark}needs={{"{kind}": "{law}"}}{mark}' for kind, law in told["needs"].items())
    meaning = told["meaning"].replace("|", r"\|") if mark else told["meaning"]
    acted_on = "yes" if told["acted_on"] else ""
    return f"{mark}{told['symbol']}{mark}", told["unit"], told["components"], acted_on, meaning + needs
