"""The `wheelchair` command: what there is, and how it starts."""

from __future__ import annotations

from importlib import import_module
from typing import Annotated, Any

import typer

from .. import __version__
from .group import Group

# Modules in the order of --help; each has `register(app)`.
COMMANDS = ("simulate", "linearize", "steady", "paper", "sweep", "tyre", "check", "compare", "diagnose", "fleet", "add",
            "improve", "report", "workbench", "effects", "ssp")  # fmt: skip


class Commands(Group):
    """Loads a command when it is asked for: all of them take two seconds, with all that they rest on."""

    def list_commands(self, ctx: Any) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        if cmd_name in COMMANDS and cmd_name not in self.commands:
            alone = typer.Typer()
            import_module(f".{cmd_name}", __package__).register(alone)
            self.commands |= typer.main.get_group(alone).commands
        return super().get_command(ctx, cmd_name)

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        if args[0] not in COMMANDS:  # all are needed for a guess at what was meant
            for name in COMMANDS:
                self.get_command(ctx, name)
        return super().resolve_command(ctx, args)


app = typer.Typer(cls=Commands, add_completion=False, no_args_is_help=True, pretty_exceptions_enable=False,
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


def main() -> None:
    """Run the command line and exit with its code."""
    app(prog_name="wheelchair")


if __name__ == "__main__":
    main()
