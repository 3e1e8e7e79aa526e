"""`wheelchair trust`: the programs that a variant carries may run from now on; and the question on a terminal."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from ..contracts.own import carries, untrusted
from ..contracts.trust import remember
from ..errors import UsageError, WheelchairError
from ..model.variant import programs_in
from .group import console
from .terminal import announce, printable


def register(app: typer.Typer) -> None:
    app.command()(trust)


def trust(file: Annotated[Path, typer.Argument(metavar="TOML", help="A variant that you have read.")]) -> None:
    """Let the effects and laws in a variant from elsewhere run here, with your rights; read them in the file first."""
    programs = programs_in(file)
    if not programs:
        raise UsageError(f"{file}: carries no effects or laws of anybody's own, so there is nothing to trust")
    remember(programs.values())
    for what, program in programs.items():
        announce(f"{what} is trusted (sha256 {program.sha256})")


def variant_option(help: str) -> typer.models.OptionInfo:
    """`--variant TOML`; a person at a terminal is asked about programs in it that nobody has trusted yet."""
    option: typer.models.OptionInfo = typer.Option("--variant", metavar="TOML", help=help, callback=asked)
    return option


def asked(variant: Path | None) -> Path | None:
    """The same file. Where the answer is no, or nobody is there to ask, whoever reads the file refuses it in a sentence."""
    if variant is None or not (sys.stdin.isatty() and sys.stderr.isatty()):
        return variant
    try:
        programs = untrusted(variant)
    except (WheelchairError, OSError):  # who reads it says so
        return variant
    if programs:
        console(stderr=True).print(f"{carries(variant, programs)}; you can read it in the file.")
        if typer.confirm(printable("Do you trust it?"), err=True):
            remember(programs.values())
    return variant
