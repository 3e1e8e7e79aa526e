"""`wheelchair report`: one HTML file, alive: tick an effect, watch the error fall; or the supplement of a paper."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from ..api.diagnosing import page_of, searched, supplement_of
from ..campaign import Campaign, windows
from ..errors import Failure
from ..model.former import former
from ..writing import written
from .group import Progress, working
from .settings import subject
from .terminal import announce
from .trust import variant_option


def register(app: typer.Typer) -> None:
    app.command()(report)


def report(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    output: Annotated[
        Path | None,
        typer.Option(
            *("-o", "--output"), metavar="PLACE", help="The page (report.html), or the folder of --paper (supplement)."
        ),
    ] = None,
    diagnosis: Annotated[
        Path | None, typer.Option(metavar="JSON", help="What `diagnose --json` wrote, instead of diagnosing again.")
    ] = None,
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values to start from.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    paper: Annotated[
        bool, typer.Option("--paper", help="Write a paper's supplement instead: methods, tables, figures, fingerprints.")
    ] = False,
    progress: Progress = False,
) -> None:
    """Write one self-contained page with the verdict, its evidence, and the model itself to try it on."""
    chair, measured, fixed = subject(campaign, variant, effects, settings)
    measured = windows(measured)
    with working("reading", lines=progress) as say:
        told = _read(diagnosis, measured) if diagnosis else searched(measured, chair, fixed, say)[1]
        if paper:
            folder, place = output or Path("supplement"), str(diagnosis or campaign)
            files = supplement_of(measured, chair, told, fixed, folder, place, say)
        else:
            say("writing the page")
            html, files = page_of(measured, chair, told, fixed), (output or Path("report.html"),)
    if not paper:
        with written(files[0]) as beside:
            beside.write_text(html, encoding="utf-8")
    for file in files:
        announce(file)


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
    named = (f"effect.{row['effect']}.{name}" for row in told["ranking"] for name in row["parameters"])
    if old := dict(former(named)):
        raise Failure(f"{file}: has the former names {', '.join(old)}, from an earlier version; diagnose the campaign again")
    return told
