"""`wheelchair add`: put an effect in, refit, and see the error fall on runs that were held out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import unknown
from ..inference.decision.improve import add as add_effects
from ..inference.estimation.statistics import standard_errors
from ..report.words import value_text
from .files import print_json
from .group import Progress, console, working
from .settings import catalogue, subject
from .staircase import physical_staircase, staircase_table, write_improved
from .terminal import announce
from .trust import variant_option


def register(app: typer.Typer) -> None:
    app.command()(add)


def add(
    ids: Annotated[
        str,
        typer.Argument(metavar="ID[,ID...]", help="An effect, as `wheelchair effects list` names it, or several by commas."),
    ],
    campaign: Annotated[Path, typer.Argument(metavar="CAMPAIGN", help="A folder with campaign.toml.")],
    output: Annotated[Path, typer.Option("-o", "--output", metavar="TOML", help="The improved variant.")],
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="Any FMI parameter.")] = None,
    variant: Annotated[Path | None, variant_option("The variant to improve.")] = None,
    effects: Annotated[Path | None, typer.Option(metavar="DIR", help="A folder with effect files of your own.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the staircase as JSON.")] = False,
    progress: Progress = False,
) -> None:
    """Refit with one more effect or several, print and draw the staircase, and write the improved variant."""
    known, wanted = catalogue(effects), [name for one in ids.split(",") if (name := one.strip())]
    for name in wanted or [ids]:
        if name not in known:
            raise unknown("effect", name, known)
    chair, measured, fixed = subject(campaign, variant, effects, settings)
    with working("calibrating", lines=progress) as say:
        better = add_effects(measured, chair, wanted, fixed, say)
    files = write_improved(output, better.variant, better.ladder)
    estimates = {
        name: value_text(better.fit.values[name], se, better.records[name].unit)
        for name, se in standard_errors(better.fit).items()
    }
    if as_json:
        steps = [step.as_json() for step in better.ladder]
        content = {
            "ladder": steps,
            "physical": better.ladder[-1].physical,
            "values": dict(better.variant.values),
            "estimates": estimates,
            "variant": str(output),
            "notes": list(better.notes),
        }
        print_json(content)
        return
    for note in better.notes:
        console().print(f"note: {note}")
    console().print(staircase_table(better.ladder))
    console().print(physical_staircase(better.ladder))
    for name, said in estimates.items():
        console().print(f"{name} = {said}")
    for file in files:
        announce(file)
