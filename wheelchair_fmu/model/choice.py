"""Which laws a model is made of: bundled ones, those of a user's configuration, and those that a choice brings along as text.

What comes along goes wherever the choice goes: out of a variant's file, into other processes, into an FMU.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from types import ModuleType
from typing import Any

from .. import configuration
from ..errors import unknown
from . import caster, lawful, tyre, wheel
from .stage import Alternative, Program

KINDS: Mapping[str, ModuleType] = {"tyre": tyre, "caster": caster, "wheel": wheel}  # of laws that may be a user's own


@dataclass(frozen=True)
class OwnLaw:
    """A law of somebody's own: what a file in `laws/<kind>` of a configuration holds, and where it was read."""

    kind: str
    name: str
    text: str
    file: str = field(compare=False, repr=False)

    @property
    def program(self) -> Program:
        return Program(self.file, self.text)

    @property
    def law(self) -> Alternative:
        """What the text makes, which is run once. Raises ModelError where it makes no law."""
        return _read(self.kind, self.name, self.text, self.file)

    def __str__(self) -> str:
        return f"{self.kind} law {self.name}"


@cache
def _read(kind: str, name: str, text: str, file: str) -> Alternative:
    return lawful.law_of_text(KINDS[kind].__name__, name, text, file)


@dataclass(frozen=True)
class Choice:
    """Which laws a model is made of; `own` are those that come along, whether chosen or not."""

    tyre: str = "linear"
    caster: str = "ideal"
    wheel: str = "rolling"
    equations: str = "extended"  # or "paper": (9)–(22) to the letter, forward motion only
    own: tuple[OwnLaw, ...] = ()

    def with_laws(self, laws: Mapping[str, str]) -> Choice:
        """The same with other laws, by what they are for ("tyre", "caster", "wheel", "equations")."""
        changed: dict[str, Any] = dict(laws)
        return replace(self, **changed)


def laws(kind: str, choice: Choice) -> dict[str, Alternative]:
    """All laws of a kind by name: the bundled ones, those of the configuration, and those that the choice brings along."""
    return {**KINDS[kind].LAWS, **{own.name: own.law for own in choice.own if own.kind == kind}}


def law(kind: str, choice: Choice, name: str = "") -> Alternative:
    """The chosen law of a kind, or another one by its name. Raises UsageError for an unknown one."""
    known, name = laws(kind, choice), name or getattr(choice, kind)
    if name not in known:
        raise unknown(f"{kind} law", name, known)
    return known[name]


def names(choice: Choice = Choice()) -> dict[str, tuple[str, ...]]:
    """What may be chosen, by what it is chosen for."""
    return {
        "tyre": tuple(laws("tyre", choice)),
        "caster": tuple(name for name in laws("caster", choice) if name != "paper"),
        "wheel": tuple(name for name in laws("wheel", choice) if name != "paper"),
        "equations": ("extended", "paper"),
    }


def serves(choice: Choice, kind: str, needed: str) -> bool:
    """Does the choice have the law that an effect needs, or one that stands in for it?"""
    own = getattr(choice, kind)
    return own == needed or (kind in KINDS and needed in law(kind, choice).serves)


def configured(kind: str) -> dict[str, OwnLaw]:
    """The laws of a kind in the user's configuration, by name."""
    files = configuration.files(f"laws/{kind}").values()
    return {file.stem: OwnLaw(kind, file.stem, file.read_text(encoding="utf-8"), str(file)) for file in files}


def taken_along(choice: Choice, names: Mapping[str, float]) -> tuple[OwnLaw, ...]:
    """The user's own laws that a chair with these values needs elsewhere: the chosen ones, those whose parameters have values,
    and those that the choice brings along."""
    mine = {(own.kind, own.name): own for own in choice.own}
    for kind in KINDS:
        for name, own in configured(kind).items():
            needed = name == getattr(choice, kind) or any(p.name in names for p in KINDS[kind].LAWS[name].parameters)
            if needed and name in KINDS[kind].LAWS:
                mine.setdefault((kind, name), own)
    return tuple(mine[key] for key in sorted(mine))
