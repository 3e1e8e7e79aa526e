"""Effects and laws of a user's own inside the file of a variant: each program as text, with its digest::

[own.rubbing_brake]
sha256 = "5f0c..."
source = '''
...
'''

[own_laws.tyre.brush]
sha256 = "77ab..."
source = '''
...
'''
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Mapping, MutableMapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomli_w

from ..errors import UsageError
from .choice import KINDS, OwnLaw, configured
from .effects import NAME, bundled
from .stage import Effect, Program

TABLE, LAWS_TABLE = "own", "own_laws"
KEYS = {"sha256", "source"}
SAID = "# Programs: they run with the rights of whoever uses this file."
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f]|'''|'\\Z")  # what a literal string of TOML cannot hold


@dataclass(frozen=True)
class Carried:
    """The programs in a variant's file: effects by their ids, and laws. None has been run."""

    effects: Mapping[str, Program] = field(default_factory=dict)
    laws: tuple[OwnLaw, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.effects or self.laws)

    def programs(self) -> dict[str, Program]:
        """By what each is: "effect rubbing_brake", "tyre law brush"."""
        return {**{f"effect {id}": p for id, p in self.effects.items()}, **{str(own): own.program for own in self.laws}}


def read(file: MutableMapping[str, Any], path: Path) -> Carried:
    """The programs that a variant's file holds, whose tables are taken out of it; none is run.

    Raises UsageError for what is no program, a name that is taken, and a source that is not its digest's.
    """
    return Carried(programs(file.pop(TABLE, {}), path), own_laws(file.pop(LAWS_TABLE, {}), path))


def programs(table: object, path: Path) -> dict[str, Program]:
    """The programs of effects, by their ids. Raises as `read`."""
    if not isinstance(table, dict):
        raise UsageError(f"{TABLE} = {table!r} is no table; write [{TABLE}.my_drag] with sha256 and source below it")
    return {
        id: _program(f"{TABLE}.{id}", "an effect", id, entry, path, bundled(), "the catalogue") for id, entry in table.items()
    }


def own_laws(table: object, path: Path) -> tuple[OwnLaw, ...]:
    """The laws, as text. Raises as `read`."""
    kinds = table.items() if isinstance(table, dict) else ()
    if not isinstance(table, dict) or not all(kind in KINDS and isinstance(entries, dict) for kind, entries in kinds):
        known = ", ".join(KINDS)
        raise UsageError(f"{LAWS_TABLE} holds {known} laws; write [{LAWS_TABLE}.tyre.my_law] with sha256 and source below it")
    return tuple(_law(kind, name, entry, path) for kind, entries in kinds for name, entry in entries.items())


def _law(kind: str, name: str, entry: object, path: Path) -> OwnLaw:
    taken = KINDS[kind].LAWS.keys() - configured(kind).keys()
    program = _program(f"{LAWS_TABLE}.{kind}.{name}", f"a {kind} law", name, entry, path, taken, "the package")
    return OwnLaw(kind, name, program.text, program.file)


def _program(place: str, what: str, name: str, entry: object, path: Path, taken: Container[str], whose: str) -> Program:
    if not NAME.fullmatch(name):
        raise UsageError(f"[{place}] is no name for {what}; use small letters, digits and underscores, like my_drag")
    if not isinstance(entry, Mapping) or set(entry) != KEYS or not all(isinstance(text, str) for text in entry.values()):
        raise UsageError(
            f"[{place}] is no {what.partition(' ')[2]}; it has two texts, sha256 and source, as `wheelchair add` writes them"
        )
    if name in taken:
        raise UsageError(
            f"it carries {what} {name!r}, and {whose} has one of that name; give your own another name, and add it again"
        )
    program = Program(f"{path}/{name}.py", entry["source"])
    if program.sha256 != entry["sha256"]:
        raise UsageError(
            f"the source of {name} was changed after it was written: its digest is {program.sha256[:12]}..., and sha256 says "
            f"{entry['sha256'][:12]!r}...; take the file again from where it came"
        )
    return program


def text(effects: Iterable[Effect], laws: Iterable[OwnLaw] = ()) -> str:
    """The tables of these laws, and of those among these effects that are a user's own, as TOML; "" where there are none."""
    own = [((TABLE, effect.id), effect.program) for effect in effects if effect.program]
    every = [*own, *(((LAWS_TABLE, law.kind, law.name), law.program) for law in laws)]
    return "".join((f"\n{SAID}\n", *(_table(keys, program) for keys, program in every))) if every else ""


def _table(keys: tuple[str, ...], program: Program) -> str:
    """The source as it is, for a person to read before it is run, unless it has what TOML must escape."""
    if _CONTROL.search(program.text):
        table: dict[str, Any] = {"sha256": program.sha256, "source": program.text}
        for key in reversed(keys):
            table = {key: table}
        return tomli_w.dumps(table, multiline_strings=True)
    return f"[{'.'.join(keys)}]\nsha256 = \"{program.sha256}\"\nsource = '''\n{program.text}'''\n"
