"""`wheelchair export`: a campaign as a problem of parameter estimation, for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..api.problems import export
from .settings import subject
from .terminal import announce
from .trust import variant_option


def register(app: typer.Typer) -> None:
    app.command(name="export")(export_command)


def export_command(
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="DIR", help="Where the problem's files go.")],
    fit: Annotated[str, typer.Option(metavar="IDS", help="Effects to be fitted beside what is calibrated, with commas.")] = "",
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("Laws, effects and values to start from.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
) -> None:
    """Write the chair as an FMU and what was measured, is known and is to be fitted as tables after PEtab 2."""
    chair, measured, _ = subject(campaign, variant, effects, settings)
    for file in export(measured, chair, [e.strip() for e in fit.split(",") if e.strip()], output):
        announce(file)
