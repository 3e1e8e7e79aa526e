"""Effects of a user's own inside the file of a variant: each program as text, with its digest::

[own.rubbing_brake]
sha256 = "5f0c..."
source = '''
...
'''
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import tomli_w

from ..errors import UsageError
from .effects import NAME, bundled
from .stage import Effect, Program

TABLE = "own"
KEYS = {"sha256", "source"}
SAID = "# Programs: they run with the rights of whoever uses this file."
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f]|'''|'\\Z")  # what a literal string of TOML cannot hold


def programs(table: object, path: Path) -> dict[str, Program]:
    """The programs in the table `own` of a variant's file, by the effects' ids; none is run.

    Raises UsageError for what is no program, a name that a bundled effect has, and a source that is not its digest's.
    """
    if not isinstance(table, dict):
        raise UsageError(f"{TABLE} = {table!r} is no table; write [{TABLE}.my_drag] with sha256 and source below it")
    return {id: _program(id, entry, path) for id, entry in table.items()}


def _program(id: str, entry: object, path: Path) -> Program:
    if not NAME.fullmatch(id):
        raise UsageError(f"[{TABLE}.{id}] is no name for an effect; use small letters, digits and underscores, like my_drag")
    if not isinstance(entry, Mapping) or set(entry) != KEYS or not all(isinstance(text, str) for text in entry.values()):
        raise UsageError(f"[{TABLE}.{id}] is no effect; it has two texts, sha256 and source, as `wheelchair add` writes them")
    if id in bundled():
        raise UsageError(
            f"it carries an effect {id!r}, and the catalogue has one of that name; give your own another name, and add it again"
        )
    program = Program(f"{path}/{id}.py", entry["source"])
    if program.sha256 != entry["sha256"]:
        raise UsageError(
            f"the source of {id} was changed after it was written: its digest is {program.sha256[:12]}..., and sha256 says "
            f"{entry['sha256'][:12]!r}...; take the file again from where it came"
        )
    return program


def text(effects: Iterable[Effect]) -> str:
    """The tables of those among these effects that are a user's own, as TOML; "" where there are none."""
    own = [(effect.id, effect.program) for effect in effects if effect.program]
    return "".join((f"\n{SAID}\n", *(_table(id, program) for id, program in own))) if own else ""


def _table(id: str, program: Program) -> str:
    """The source as it is, for a person to read before it is run, unless it has what TOML must escape."""
    if _CONTROL.search(program.text):
        table: dict[str, Any] = {"sha256": program.sha256, "source": program.text}
        return tomli_w.dumps({TABLE: {id: table}}, multiline_strings=True)
    return f"[{TABLE}.{id}]\nsha256 = \"{program.sha256}\"\nsource = '''\n{program.text}'''\n"
