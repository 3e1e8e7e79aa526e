"""The `wheelchair` command: what there is, and how it starts."""

from __future__ import annotations

import atexit
import gc
from importlib import import_module
from keyword import iskeyword
from typing import Annotated, Any

import typer

from .. import __version__
from ..errors import unknown
from .group import Group

COLLECTED = 100_000  # objects: to look through all of them as often as is usual takes 3 % of a diagnosis

# Modules, each with `register(app)`, and what they are for.
COMMANDS = {
    "build": "Build the FMU of a chair.",
    "sample": "Unpack the sample campaign.",
    "simulate": "Put the chair through a manoeuvre.",
    "linearize": "Find a steady turn and linearise the chair about it, exactly.",
    "steady": "Understeer, oversteer, and the limits of a turn, against speed.",
    "paper": "Run sections 6.1 to 6.3 of the paper.",
    "sweep": "Simulate every chair of a plan.",
    "tyre": "Tyres identified from rig data.",
    "import": "Make a campaign from recordings, whoever wrote them.",
    "check": "Read a campaign and print all its faults: place, fact, cure.",
    "sync": "Find the clocks of a campaign's devices.",
    "compare": "Simulate every run, and say how far off the model is.",
    "diagnose": "Say which physical effect is missing, with the evidence.",
    "fleet": "Diagnose every campaign of a fleet.",
    "add": "Refit with one more effect, and write the improved variant.",
    "improve": "Diagnose and add, until nothing is missing.",
    "report": "Write one page with the verdict, its evidence, and the model.",
    "export": "Write the problem of a fit, for other programs to solve.",
    "trust": "Let the effects and laws in a variant from elsewhere run.",
    "workbench": "Do all of this in a browser, from recordings dropped in.",
    "effects": "The physical effects that the chair can have.",
    "laws": "The laws of tyres, casters and rear wheels to choose from.",
    "surfaces": "How hard a chair rolls on floors of published measurements.",
    "quantities": "What the equations speak of, for laws of your own.",
    "ssp": "Systems of FMUs: the chair with a pusher and a floor.",
}


class Commands(Group):
    """Loads a command when it is asked for: all of them take two seconds, with all that they rest on."""

    def list_commands(self, ctx: Any) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        if cmd_name in COMMANDS and cmd_name not in self.commands:
            alone = typer.Typer(rich_markup_mode=None)  # which would take units in brackets for its own
            module = f"{cmd_name}_" if iskeyword(cmd_name) else cmd_name  # no module can be called import
            import_module(f".{module}", __package__).register(alone)
            self.commands.update(typer.main.get_group(alone).commands)
        return super().get_command(ctx, cmd_name)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        if args[0] not in COMMANDS:
            raise unknown("command", args[0], COMMANDS)
        return super().resolve_command(ctx, args)


app = typer.Typer(
    cls=Commands,
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


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


def main(words: list[str] | None = None) -> None:
    """Run the command line, or these words of one, and exit with its code."""
    gc.set_threshold(COLLECTED)
    atexit.register(gc.freeze)  # to look through all of them once more, only to end, takes a quarter of a second
    app(words, prog_name="wheelchair")
