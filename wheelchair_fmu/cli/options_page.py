"""docs/options.md: every command with its arguments and options, from the records that `--help` prints.

`python -m wheelchair_fmu.cli.options_page docs/options.md` writes it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from ..writing import written
from .main import app

HEAD = """# Every command and option

What `wheelchair COMMAND --help` prints, as one page, which `make docs` writes. [What the commands do](commands.md) shows each
of them at work. A word that is looked for in a list, such as an effect or a manoeuvre, may be misspelt: the nearest is named.
"""
TABLE = "| option | default | what |\n|---|---|---|"


def page() -> str:
    """The whole page."""
    command = typer.main.get_command(app)
    context = command.make_context("wheelchair", [], resilient_parsing=True)
    return "\n\n".join([HEAD.rstrip(), *_of(command, context)]) + "\n"


def _of(group: Any, context: Any) -> Iterator[str]:
    """Each command of a group, and those of its groups."""
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        inside = type(context)(command, info_name=name, parent=context)
        if hasattr(command, "list_commands"):
            yield from _of(command, inside)
        else:
            yield _section(command, inside)


def _section(command: Any, context: Any) -> str:
    records = (p.get_help_record(context) for p in command.get_params(context) if p.name != "help")
    rows = [_row(*record) for record in records if record]  # hidden ones have none
    told = " ".join((command.help or "").split())
    parts = [f"## {context.command_path}", told, *(["\n".join([TABLE, *rows])] if rows else [])]
    return "\n\n".join(parts)


def _row(names: str, told: str) -> str:
    """An argument or option: its names with what stands behind them, its default, and what `--help` says of it."""
    words, _, extra = told.partition("  [")
    notes = extra.rstrip("]").split("; ")
    default = next((note.removeprefix("default: ") for note in notes if note.startswith("default: ")), "")
    needed = "required" if "required" in notes else ""
    return f"| `{_cell(names)}` | {_cell(default or needed)} | {_cell(words)} |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", r"\|")


if __name__ == "__main__":
    with written(Path(sys.argv[1])) as beside:
        beside.write_text(page(), encoding="utf-8")
