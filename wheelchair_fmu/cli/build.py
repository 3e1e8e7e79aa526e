"""`wheelchair build`: the FMU of a chair, for each version of FMI."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .terminal import announce
from .trust import variant_option


def register(app: typer.Typer) -> None:
    app.command()(build)


def build(
    variant: Annotated[Path | None, variant_option("Laws, effects and values, as `wheelchair add` writes.")] = None,
    effects: Annotated[
        str, typer.Option(metavar="IDS", help="default (all without states of their own), all, none, ids, or a folder.")
    ] = "default",
    equations: Annotated[
        str | None, typer.Option(metavar="KIND", help="extended (any motion), or paper: to the letter.")
    ] = None,
    flavour: Annotated[str, typer.Option(help="native (C inside), or python (needs Python around it).")] = "native",
    fmi: Annotated[
        str | None, typer.Option(metavar="VERSION", help="2, 3 or both (the default; pythonfmu makes 2 only).")
    ] = None,
    platforms: Annotated[
        str, typer.Option(metavar="NAMES", help="host, all (Linux and macOS on x86-64 and ARM, Windows), or names with commas.")
    ] = "host",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FMU", help="Where to write it; FMI 3.0 beside it, as .fmi3.fmu.")
    ] = None,
) -> None:
    """Build dist/Wheelchair.fmu (FMI 2.0) and dist/Wheelchair.fmi3.fmu, or another variant's."""
    from ..api.building import build as make  # here, for it takes seconds

    made = make(variant, output, effects=effects, equations=equations, flavour=flavour, fmi=fmi, platforms=platforms)
    for file in made:
        announce(file)
