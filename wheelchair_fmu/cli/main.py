"""The `wheelchair` command: what there is, and how it starts."""

from __future__ import annotations

from typing import Annotated

import typer

from .. import __version__
from . import (
    add,
    check,
    compare,
    diagnose,
    effects,
    fleet,
    improve,
    linearize,
    paper,
    report,
    simulate,
    ssp,
    steady,
    sweep,
    tyre,
    workbench,
)
from .group import Group

# In the order of --help; each module has `register(app)`.
COMMANDS = (simulate, linearize, steady, paper, sweep, tyre, check, compare, diagnose, fleet, add, improve, report, workbench,
            effects, ssp)  # fmt: skip

app = typer.Typer(cls=Group, add_completion=False, no_args_is_help=True, pretty_exceptions_enable=False,
                  rich_markup_mode=None, context_settings={"help_option_names": ["-h", "--help"]})  # fmt: skip


def _version(wanted: bool) -> None:
    if wanted:
        print(f"wheelchair-fmu {__version__}")
        raise typer.Exit


@app.callback()
def wheelchair(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and stop.")
    ] = False,
) -> None:
    """A manual wheelchair on real tyres: simulate it as an FMU, and hold it against measurements."""


for _command in COMMANDS:
    _command.register(app)


def main() -> None:
    """Run the command line and exit with its code."""
    app(prog_name="wheelchair")


if __name__ == "__main__":
    main()
