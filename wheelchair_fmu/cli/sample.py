"""`wheelchair sample`: what to try the other commands on."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..api.samples import SAMPLES, sample
from .terminal import announce


def register(app: typer.Typer) -> None:
    app.command(name="sample")(sample_command)


def sample_command(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Where the files go.")],
    kind: Annotated[str, typer.Option(metavar="KIND", help=f"One of {', '.join(SAMPLES)}.")] = "campaign",
) -> None:
    """Unpack the sample campaign of a simulated chair into DIR; or a tyre's rig data, a sweep's plan, inputs for FMUs."""
    for file in sample(folder, kind):
        announce(file)
