"""A variant by what it is made of, so that it can go to other processes: of effects of a user's own go the files' contents."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from .effects import Sources, bundled, defined
from .variant import Variant
from .wheelchair import Choice


@dataclass(frozen=True)
class Recipe:
    """Laws, effects and values (FMI names, SI units); `own` are the files of a user's effects."""

    choice: Choice = Choice()
    effects: tuple[str, ...] = ()
    values: tuple[tuple[str, float], ...] = ()
    own: Sources = ()

    @classmethod
    def of(cls, variant: Variant) -> Self:
        """The recipe of a variant; all of a user's effects in its catalogue go along, also those that are off."""
        own = tuple((e.program.file, e.program.text) for e in variant.catalogue.values() if e.program)
        return cls(variant.choice, variant.effects, tuple(variant.values.items()), own)

    def variant(self) -> Variant:
        return Variant(self.choice, self.effects, dict(self.values), catalogue={**bundled(), **defined(self.own)})

    def with_effects(self, ids: Iterable[str]) -> Self:
        grown = self.variant().with_effects(ids)
        return replace(self, choice=grown.choice, effects=grown.effects)
