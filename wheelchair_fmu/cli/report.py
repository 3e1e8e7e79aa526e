"""`wheelchair report`: one HTML file, alive: tick an effect, watch the error fall."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from ..campaign import CHANNELS, Campaign, windows
from ..errors import Failure
from ..handling.experiments import experiments
from ..loop.evidence import Colour
from ..loop.story import story
from ..loop.verdict import diagnose
from ..model.generic import library
from ..model.variant import Variant
from ..report.content import content
from ..report.page import page
from ..report.tale import story_of
from ..report.words import particulars, sentence
from ..writing import written
from .group import Progress, working
from .missing import missing
from .settings import subject
from .terminal import announce


def register(app: typer.Typer) -> None:
    app.command()(report)


def report(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="HTML", help="The page.")] = Path("report.html"),
    diagnosis: Annotated[
        Path | None, typer.Option(metavar="JSON", help="What `diagnose --json` wrote, instead of diagnosing again.")
    ] = None,
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, typer.Option(metavar="TOML", help="Laws, effects and values to start from.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    progress: Progress = False,
) -> None:
    """Write one self-contained page with the verdict, its evidence, and the model itself to try it on."""
    chair, measured, fixed = subject(campaign, variant, effects, settings)
    measured = windows(measured)
    with working("reading", lines=progress) as say:
        told = _read(diagnosis, measured) if diagnosis else _diagnosed(measured, chair, fixed, say)
        say("writing the page")
        html = _html(measured, _with_proposal(chair, told), told, fixed)
    with written(output) as beside:
        beside.write_text(html, encoding="utf-8")
    announce(output)


def _diagnosed(measured: Campaign, chair: Variant, fixed: Sequence[str], say: Callable[[str], None]) -> dict[str, Any]:
    found = diagnose(measured, chair, library(), progress=say, experiments=experiments(), fixed=fixed)
    return {**story(found), "missing": missing(found)}


def _html(measured: Campaign, chair: Variant, told: Mapping[str, Any], fixed: Sequence[str]) -> str:
    titles = {e.id: e.title for e in chair.catalogue.values()}
    records = {p.name: p for e in chair.catalogue.values() for p in e.owned}
    colour = Colour({**measured.noise, **told["noise"]["sd"]}, told["noise"]["ar"])  # channels may have come since
    tale = story_of(told, titles, records, {c.name: c.unit for c in CHANNELS})
    return page(content(measured, chair, colour, told, fixed), sentence(told, titles), particulars(told, records), tale)


def _with_proposal(chair: Variant, told: Mapping[str, Any]) -> Variant:
    """The chair whose catalogue also has the generic terms that the diagnosis used."""
    named = {name.split(".")[1] for m in told["models"] for name in m["values"] if name.startswith("effect.")}
    more = {e: effect for e, effect in library().items() if e in named and e not in chair.catalogue}
    return replace(chair, catalogue={**chair.catalogue, **more})


def _read(file: Path, measured: Campaign) -> dict[str, Any]:
    """A diagnosis of this campaign that was written before. Raises Failure for any other file."""
    try:
        told: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise Failure(f"{file}: not JSON: {error}; give what `wheelchair diagnose --json` wrote") from None
    if not isinstance(told, dict) or not {"verdict", "ladder", "ranking", "models", "noise", "begins"} <= set(told):
        raise Failure(f"{file}: no diagnosis; give what `wheelchair diagnose --json` wrote")
    if told["campaign"] != measured.name:
        raise Failure(f"{file}: a diagnosis of {told['campaign']!r}, not of {measured.name!r}; diagnose this campaign")
    return told
